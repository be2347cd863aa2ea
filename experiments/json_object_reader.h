#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/parameters.h"
#include "experiments/json_document.h"
#include "experiments/problems.h"

namespace gradslc {

/// Reads one object of a document: as a visitor the parameters that a describe() declares, and besides them strings and
/// nested values. Whatever is wrong goes to `problems` with its position, and leaves the value as it was.
class JsonObjectReader final : public ParameterVisitor {
 public:
  /// Where `pointer` is not an object, that is a problem and everything reads as missing.
  JsonObjectReader(const JsonDocument& document, const std::string& pointer, Problems& problems);

  using ParameterVisitor::choice;
  using ParameterVisitor::integer;
  using ParameterVisitor::real;
  void boolean(std::string_view name, bool& value, std::string_view meaning) override;
  /// Also takes integers that are written 1e6 or 840000.0.
  void integer(std::string_view name, std::int64_t& value, Range range, std::string_view unit,
               std::string_view meaning) override;
  void real(std::string_view name, double& value, Range range, std::string_view unit,
            std::string_view meaning) override;
  void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
              std::string_view meaning) override;
  void group(std::string_view name, std::string_view meaning, const std::function<void()>& body) override;

  /// The string at `name`; nullopt where it is missing, or not a string (a problem).
  std::optional<std::string> text(std::string_view name);
  /// The pointer of the value at `name`, of any kind; nullopt where it is missing.
  std::optional<std::string> member(std::string_view name);
  /// The pointers of the elements of the array at `name`; empty where it is missing, or not an array (a problem).
  std::vector<std::string> elements(std::string_view name);

  /// Reports the value at `name`, or the object if it has none.
  void problem(std::string_view name, std::string message);
  /// Call after the walk: what the object holds and was not asked for is a problem.
  void report_unknown_keys();

 private:
  struct Level {
    const nlohmann::json* object;  // nullptr: missing
    std::string pointer;
    std::vector<std::string> known;
  };
  /// Marks `name` as known; nullptr where it is missing.
  const nlohmann::json* value_of(std::string_view name);
  /// The number at `name` where it is one and within `range`.
  std::optional<double> number(std::string_view name, const nlohmann::json& value, Range range, std::string_view unit);
  Level level_at(const std::string& pointer);

  const JsonDocument& document_;
  Problems& problems_;
  std::vector<Level> levels_;  // the object and the groups that are open in it
};

/// "an integer", "a string", ...: how messages name the kind of a value.
std::string kind_of(const nlohmann::json& value);

}  // namespace gradslc
