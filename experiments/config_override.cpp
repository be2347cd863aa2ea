#include "experiments/config_override.h"

#include <utility>

namespace gradslc {
namespace {

using nlohmann::json;

std::string pointer_of(std::string_view path) {
  if (path.starts_with('/')) return std::string(path);
  std::string pointer;
  while (true) {
    const std::size_t dot = path.find('.');
    pointer = join_pointer(pointer, path.substr(0, dot));
    if (dot == path.npos) return pointer;
    path.remove_prefix(dot + 1);
  }
}

bool is_json_pointer(const std::string& pointer) {
  try {
    const json::json_pointer parsed(pointer);
    return true;
  } catch (const json::parse_error&) {  // a "~" that is not "~0" or "~1"
    return false;
  }
}

}  // namespace

void apply_override(JsonDocument& document, std::string_view assignment) {
  const std::string origin = "--set " + std::string(assignment);
  const std::size_t equals = assignment.find('=');
  if (equals == 0 || equals == assignment.npos) throw_input_error(origin, "must be key=value");
  const std::string pointer = pointer_of(assignment.substr(0, equals));
  if (!is_json_pointer(pointer)) throw_input_error(origin, "\"" + pointer + "\" is not a JSON pointer");
  const std::string_view text = assignment.substr(equals + 1);
  json value = json::accept(text) ? JsonDocument::parse(origin, std::string(text)).root() : json(text);
  document.replace(pointer, std::move(value), origin);
}

}  // namespace gradslc
