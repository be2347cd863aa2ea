#include "experiments/json_object_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "experiments/parameter_list.h"

namespace gradslc {
namespace {

using nlohmann::json;

/// What is required of a value that lies outside of `range`.
std::string requirement(double value, const Range& range, std::string_view unit) {
  if (has_practical_upper_limit(range) || value < range.lower) return "must be " + range_text(range, unit);
  return "must be " + range_text({.upper = range.upper}, unit);
}

}  // namespace

std::string kind_of(const nlohmann::json& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return value.dump();
  if (value.is_string()) return "a string";
  return value.is_array() ? "an array" : "an object";
}

JsonObjectReader::JsonObjectReader(const JsonDocument& document, const std::string& pointer, Problems& problems)
    : document_(document), problems_(problems) {
  levels_.push_back(level_at(pointer));
}

JsonObjectReader::Level JsonObjectReader::level_at(const std::string& pointer) {
  const json* value = document_.find(pointer);
  if (value && !value->is_object()) {
    problems_.add(document_.position(pointer), "must be an object, not " + kind_of(*value));
    value = nullptr;
  }
  return {value, pointer, {}};
}

const nlohmann::json* JsonObjectReader::value_of(std::string_view name) {
  Level& level = levels_.back();
  if (std::find(level.known.begin(), level.known.end(), name) == level.known.end()) level.known.emplace_back(name);
  if (!level.object) return nullptr;
  const auto found = level.object->find(name);
  return found == level.object->end() ? nullptr : &*found;
}

void JsonObjectReader::problem(std::string_view name, std::string message) {
  const std::string pointer = join_pointer(levels_.back().pointer, name);
  problems_.add(document_.position(pointer), std::move(message));
}

void JsonObjectReader::boolean(std::string_view name, bool& value, std::string_view /*meaning*/) {
  const json* given = value_of(name);
  if (!given) return;
  if (given->is_boolean())
    value = given->get<bool>();
  else
    problem(name, "must be true or false, not " + kind_of(*given));
}

std::optional<double> JsonObjectReader::number(std::string_view name, const nlohmann::json& value, Range range,
                                               std::string_view unit) {
  const double given = value.get<double>();
  if (given >= range.lower && given <= range.upper) return given;
  problem(name, fmt::format("{}, not {}", requirement(given, range, unit), value.dump()));
  return std::nullopt;
}

void JsonObjectReader::integer(std::string_view name, std::int64_t& value, Range range, std::string_view unit,
                               std::string_view /*meaning*/) {
  const json* given = value_of(name);
  if (!given) return;
  if (!given->is_number() || given->get<double>() != std::floor(given->get<double>()))
    return problem(name, "must be an integer, not " + kind_of(*given));
  // The largest double below 2^63; beyond it a conversion to int64 would overflow.
  range.upper = std::min(range.upper, std::nextafter(0x1p63, 0.0));
  range.lower = std::max(range.lower, -0x1p63);
  if (const std::optional<double> checked = number(name, *given, range, unit))
    value = given->is_number_integer() ? given->get<std::int64_t>() : static_cast<std::int64_t>(*checked);
}

void JsonObjectReader::real(std::string_view name, double& value, Range range, std::string_view unit,
                            std::string_view /*meaning*/) {
  const json* given = value_of(name);
  if (!given) return;
  if (!given->is_number()) return problem(name, "must be a number, not " + kind_of(*given));
  // Parameters are stored as float; no useful value lies beyond it.
  constexpr double k_largest = std::numeric_limits<float>::max();
  if (std::abs(given->get<double>()) > k_largest)
    return problem(name, fmt::format("must be below {:.3g}, not {}", k_largest, given->dump()));
  if (const std::optional<double> checked = number(name, *given, range, unit)) value = *checked;
}

void JsonObjectReader::choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
                              std::string_view /*meaning*/) {
  const std::optional<std::string> given = text(name);
  if (!given) return;
  const auto found = std::find(names.begin(), names.end(), *given);
  if (found != names.end())
    index = static_cast<std::size_t>(found - names.begin());
  else
    problem(name, fmt::format("\"{}\" is unknown{}", *given, suggestion(*given, names)));
}

void JsonObjectReader::group(std::string_view name, std::string_view /*meaning*/, const std::function<void()>& body) {
  value_of(name);
  levels_.push_back(level_at(join_pointer(levels_.back().pointer, name)));
  body();
  report_unknown_keys();
  levels_.pop_back();
}

std::optional<std::string> JsonObjectReader::text(std::string_view name) {
  const json* given = value_of(name);
  if (!given) return std::nullopt;
  if (given->is_string()) return given->get<std::string>();
  problem(name, "must be a string, not " + kind_of(*given));
  return std::nullopt;
}

std::optional<std::string> JsonObjectReader::member(std::string_view name) {
  if (!value_of(name)) return std::nullopt;
  return join_pointer(levels_.back().pointer, name);
}

std::vector<std::string> JsonObjectReader::elements(std::string_view name) {
  const json* given = value_of(name);
  if (!given) return {};
  if (!given->is_array()) {
    problem(name, "must be an array, not " + kind_of(*given));
    return {};
  }
  const std::string pointer = join_pointer(levels_.back().pointer, name);
  std::vector<std::string> pointers;
  pointers.reserve(given->size());
  for (std::size_t i = 0; i < given->size(); ++i) pointers.push_back(join_pointer(pointer, i));
  return pointers;
}

void JsonObjectReader::report_unknown_keys() {
  const Level& level = levels_.back();
  if (!level.object) return;
  for (const auto& [key, value] : level.object->items()) {
    if (std::find(level.known.begin(), level.known.end(), key) != level.known.end()) continue;
    problems_.add(document_.key_position(join_pointer(level.pointer, key)),
                  "unknown key" + suggestion(key, level.known));
  }
}

}  // namespace gradslc
