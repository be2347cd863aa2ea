#include "experiments/parameter_writer.h"

#include <string>

namespace gradslc {

void JsonParameterWriter::boolean(std::string_view name, bool& value, std::string_view /*meaning*/) {
  (*level_)[std::string(name)] = value;
}

void JsonParameterWriter::integer(std::string_view name, std::int64_t& value, Range /*range*/,
                                  std::string_view /*unit*/, std::string_view /*meaning*/) {
  (*level_)[std::string(name)] = value;
}

void JsonParameterWriter::real(std::string_view name, double& value, Range /*range*/, std::string_view /*unit*/,
                               std::string_view /*meaning*/) {
  (*level_)[std::string(name)] = value;
}

void JsonParameterWriter::choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
                                 std::string_view /*meaning*/) {
  (*level_)[std::string(name)] = names.at(index);
}

void JsonParameterWriter::group(std::string_view name, std::string_view /*meaning*/,
                                const std::function<void()>& body) {
  nlohmann::json* const enclosing = level_;
  level_ = &((*enclosing)[std::string(name)] = nlohmann::json::object());
  body();
  level_ = enclosing;
}

}  // namespace gradslc
