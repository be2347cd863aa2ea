#pragma once

#include <nlohmann/json.hpp>

#include "core/parameters.h"

namespace gradslc {

/// Writes the current values of the parameters that a describe() declares: what a run really used, for the manifest.
/// Reading the result back gives the same values.
class JsonParameterWriter final : public ParameterVisitor {
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

  /// An object.
  const nlohmann::json& values() const { return values_; }

 private:
  nlohmann::json values_ = nlohmann::json::object();
  nlohmann::json* level_ = &values_;
};

}  // namespace gradslc
