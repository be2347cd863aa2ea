#pragma once
// A parameter is declared once, in the describe() of what owns it. JSON parsing, ranges, unknown-key checks, `list`,
// the schema, the manual and the manifest are visitors that walk these declarations.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gradslc {

/// Closed range of allowed values.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};
constexpr Range at_least(double lower) { return {lower, std::numeric_limits<double>::infinity()}; }

/// The double that prints like the float: 0.1f gives 0.1, which rounds back to the same float.
double shortest_double(float value);

/// Walks the parameters of one object. `name` is the JSON key; the current value is the default when nothing is read.
class ParameterVisitor {
 public:
  virtual ~ParameterVisitor() = default;

  virtual void boolean(std::string_view name, bool& value, std::string_view meaning) = 0;
  virtual void integer(std::string_view name, std::int64_t& value, Range range, std::string_view unit,
                       std::string_view meaning) = 0;
  virtual void real(std::string_view name, double& value, Range range, std::string_view unit,
                    std::string_view meaning) = 0;
  /// One of `names`; `index` is the position of the current one.
  virtual void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
                      std::string_view meaning) = 0;
  /// Parameters of a nested object: its describe() is called by `body`.
  virtual void group(std::string_view name, std::string_view meaning, const std::function<void()>& body) = 0;

  // The same for the types that parameters have in structs.
  void integer(std::string_view name, int& value, Range range, std::string_view unit, std::string_view meaning) {
    auto wide = static_cast<std::int64_t>(value);
    range.upper = std::min(range.upper, static_cast<double>(std::numeric_limits<int>::max()));
    integer(name, wide, range, unit, meaning);
    value = static_cast<int>(wide);
  }
  void real(std::string_view name, float& value, Range range, std::string_view unit, std::string_view meaning) {
    double wide = shortest_double(value);
    real(name, wide, range, unit, meaning);
    value = static_cast<float>(wide);
  }
  /// An enumeration whose values are 0, 1, ... in the order of `names`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(std::string_view name, Enum& value, const std::vector<std::string>& names, std::string_view meaning) {
    auto index = static_cast<std::size_t>(value);
    choice(name, index, names, meaning);
    value = static_cast<Enum>(index);
  }
};

}  // namespace gradslc
