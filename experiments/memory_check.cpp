#include "experiments/memory_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/memory.h"
#include "scene/scene.h"
#include "vpl/vpl.h"

namespace gradslc {
namespace {

/// Rounded down to two digits: what fits with something to spare.
double rounded_down(double count) {
  if (count < 10) return std::floor(count);
  const double unit = std::pow(10.0, std::floor(std::log10(count)) - 1);
  return std::floor(count / unit) * unit;
}

}  // namespace

std::vector<PlannedRun> plan_memory(const std::vector<MethodPlan>& methods, const std::string& scene_name,
                                    const Scene& scene, const RenderSettings& settings, const Makers& makers) {
  std::vector<PlannedRun> runs;
  runs.reserve(runs.size() + methods.size());
  for (const MethodPlan& method : methods)
    if (method.render_of.empty())
      runs.push_back({scene_name, method.name, makers.integrator(method)->plan_memory(scene, settings)});
  return runs;
}

double peak_bytes(const std::vector<PlannedRun>& runs) {
  double resident = 0, beyond = 0;
  for (const PlannedRun& run : runs) {
    resident += run.memory.resident_bytes;
    beyond = std::max(beyond, run.memory.peak_bytes - run.memory.resident_bytes);
  }
  return resident + beyond;
}

void require_memory(const std::vector<PlannedRun>& runs, double available) {
  if (runs.empty()) return;
  const PlannedRun& largest = *std::max_element(runs.begin(), runs.end(), [](const PlannedRun& a, const PlannedRun& b) {
    return a.memory.peak_bytes < b.memory.peak_bytes;
  });
  const double share = available / peak_bytes(runs);
  const double numbered = static_cast<double>(VplSet::k_most) / largest.memory.vpls;
  if (share >= 1 && numbered >= 1) return;
  const std::string limit =
      share < 1 ? fmt::format("{} with {} available", format_bytes(peak_bytes(runs)), format_bytes(available))
                : fmt::format("{:.3g} VPLs where {} can be numbered", largest.memory.vpls, VplSet::k_most);
  throw_input_error(largest.scene,
                    fmt::format("method \"{}\": {:.0f} light paths{} need {}; {:.0f} would fit", largest.method,
                                largest.memory.light_paths, runs.size() > 1 ? " beside the other methods" : "", limit,
                                rounded_down(largest.memory.light_paths * std::min(share, numbered))));
}

std::string describe(const PlannedRun& run) {
  return fmt::format("{}: {}: {:.0f} light paths, {:.3g} VPLs, {}", run.scene, run.method, run.memory.light_paths,
                     run.memory.vpls, format_bytes(run.memory.peak_bytes));
}

}  // namespace gradslc
