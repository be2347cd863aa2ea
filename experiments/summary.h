#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/results.h"
#include "experiments/statistics.h"

namespace gradslc {

/// A method on a scene at the end of its budget: means over repeats with 95 % intervals.
struct MethodSummary {
  std::string method;
  Estimate seconds, cpu_seconds, passes, rays;
  std::optional<double> largest_budget_miss;  ///< of the repeats, the one farthest from 0; budgets in seconds only

  /// What is measured against a reference.
  struct Errors {
    Estimate relmse, relmse_trimmed, mean_bias;
    Estimate inefficiency, inefficiency_trimmed;  ///< (trimmed) relmse x wall seconds, per repeat
    std::optional<Estimate> primal_relmse;        ///< of the image without its reconstruction
    /// Trimmed relmse of the light that VPLs can represent alone, and the same x wall seconds.
    std::optional<Estimate> vpl_light_trimmed, vpl_light_inefficiency;
  };
  std::optional<Errors> errors;
  std::vector<std::string> flags;  ///< of any repeat
};

struct SceneSummary {
  std::string scene;
  std::vector<MethodSummary> methods;  ///< in the order of the experiment; the first is what others are compared with
  bool equal_time = false;             ///< budgets in seconds
};

/// Sums up the final curve points, scenes and methods in the order of their first rows.
std::vector<SceneSummary> summarise(std::span<const ResultRow> rows);

/// How much smaller an inefficiency is than the first method's.
struct Factor {
  double value;      ///< > 1: better
  bool significant;  ///< the 95 % intervals of the two have nothing in common
};
/// nullopt where one of the two is not positive: then the error is below what the reference can tell.
std::optional<Factor> improvement(const Estimate& first, const Estimate& other);

/// Which method wins and by what factor, in sentences, with what there is to say against it.
std::vector<std::string> verdict(const SceneSummary& summary);

}  // namespace gradslc
