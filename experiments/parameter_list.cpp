#include "experiments/parameter_list.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace gradslc {

std::string ParameterLister::path_of(std::string_view name) const { return prefix_ + std::string(name); }

void ParameterLister::boolean(std::string_view name, bool& value, std::string_view meaning) {
  parameters_.push_back({path_of(name), "boolean", value, {}, {}, {}, std::string(meaning)});
}

void ParameterLister::integer(std::string_view name, std::int64_t& value, Range range, std::string_view unit,
                              std::string_view meaning) {
  parameters_.push_back({path_of(name), "integer", value, range, {}, std::string(unit), std::string(meaning)});
}

void ParameterLister::real(std::string_view name, double& value, Range range, std::string_view unit,
                           std::string_view meaning) {
  parameters_.push_back({path_of(name), "real", value, range, {}, std::string(unit), std::string(meaning)});
}

void ParameterLister::choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
                             std::string_view meaning) {
  parameters_.push_back({path_of(name), "choice", names.at(index), {}, names, {}, std::string(meaning)});
}

void ParameterLister::group(std::string_view name, std::string_view /*meaning*/, const std::function<void()>& body) {
  const std::string enclosing = std::exchange(prefix_, path_of(name) + ".");
  body();
  prefix_ = enclosing;
}

bool has_practical_upper_limit(const Range& range) { return range.upper < std::numeric_limits<int>::max(); }

std::string range_text(const Range& range, std::string_view unit) {
  std::string text = "any";
  if (std::isfinite(range.lower) && has_practical_upper_limit(range))
    text = fmt::format("{} to {}", range.lower, range.upper);
  else if (std::isfinite(range.lower))
    text = fmt::format("at least {}", range.lower);
  else if (std::isfinite(range.upper))
    text = fmt::format("at most {}", range.upper);
  return unit.empty() ? text : fmt::format("{} [{}]", text, unit);
}

std::string allowed_values(const ParameterInfo& parameter) {
  if (parameter.type == "boolean") return "true | false";
  if (parameter.type == "choice") return fmt::format("{}", fmt::join(parameter.choices, " | "));
  return range_text(parameter.range, parameter.unit);
}

std::string default_text(const ParameterInfo& parameter) {
  const nlohmann::json& value = parameter.default_value;
  return value.is_string()   ? value.get<std::string>()
         : value.is_number() ? fmt::format("{}", value.get<double>())
                             : value.dump();
}

nlohmann::json to_json(const ParameterInfo& parameter) {
  nlohmann::json entry = {{"path", parameter.path},
                          {"type", parameter.type},
                          {"default", parameter.default_value},
                          {"meaning", parameter.meaning}};
  if (std::isfinite(parameter.range.lower)) entry["minimum"] = parameter.range.lower;
  if (std::isfinite(parameter.range.upper)) entry["maximum"] = parameter.range.upper;
  if (!parameter.choices.empty()) entry["choices"] = parameter.choices;
  if (!parameter.unit.empty()) entry["unit"] = parameter.unit;
  return entry;
}

}  // namespace gradslc
