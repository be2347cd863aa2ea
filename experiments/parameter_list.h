#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/parameters.h"

namespace gradslc {

/// A parameter as `list` shows it.
struct ParameterInfo {
  std::string path;  ///< dotted through its groups ("vpl.light_paths"), as --set takes it
  std::string type;  ///< "boolean", "integer", "real" or "choice"
  nlohmann::json default_value;
  Range range;                       ///< of integers and reals
  std::vector<std::string> choices;  ///< of choices
  std::string unit, meaning;
};

/// Collects the declarations of a describe(); the current values are the defaults.
class ParameterLister final : public ParameterVisitor {
 public:
  using ParameterVisitor::choice;
  using ParameterVisitor::integer;
  using ParameterVisitor::real;
  void boolean(std::string_view name, bool& value, std::string_view meaning) override;
  void integer(std::string_view name, std::int64_t& value, Range range, std::string_view unit,
               std::string_view meaning) override;
  void real(std::string_view name, double& value, Range range, std::string_view unit,
            std::string_view meaning) override;
  void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
              std::string_view meaning) override;
  void group(std::string_view name, std::string_view meaning, const std::function<void()>& body) override;

  const std::vector<ParameterInfo>& parameters() const { return parameters_; }

 private:
  std::string path_of(std::string_view name) const;

  std::string prefix_;  // "vpl." within the group vpl
  std::vector<ParameterInfo> parameters_;
};

/// Whether the upper end says more than what the type can hold.
bool has_practical_upper_limit(const Range& range);
/// "1 to 64 [pixels]", "at least 0", "any".
std::string range_text(const Range& range, std::string_view unit);
/// What values it takes, for people: "1 to 64 [pixels]", "at least 0", "none | clamp".
std::string allowed_values(const ParameterInfo& parameter);
/// Its default, for people.
std::string default_text(const ParameterInfo& parameter);
/// Keys path, type, default, minimum, maximum, choices, unit, meaning; those that say nothing are left out.
nlohmann::json to_json(const ParameterInfo& parameter);

}  // namespace gradslc
