#pragma once

#include <string>
#include <vector>

#include "experiments/makers.h"

namespace gradslc {

/// One method on one scene, and what it is expected to need.
struct PlannedRun {
  std::string scene, method;
  MemoryPlan memory;
};

/// Plans the memory of every method on a scene.
std::vector<PlannedRun> plan_memory(const std::vector<MethodPlan>& methods, const std::string& scene_name,
                                    const Scene& scene, const RenderSettings& settings, const Makers& makers);

/// Bytes of methods that take turns: what all of them hold, and the most that one needs beyond that.
double peak_bytes(const std::vector<PlannedRun>& runs);

/// Error (input) where methods that take turns need more than `available` bytes or a set has more VPLs than can be
/// numbered: which method, how much, and with how many light paths it would fit.
void require_memory(const std::vector<PlannedRun>& runs, double available);

/// "scene: method: 42000000 light paths, 1.05e+08 VPLs, 11.0 GiB".
std::string describe(const PlannedRun& run);

}  // namespace gradslc
