#pragma once

#include <string>

#include "integrators/integrator.h"
#include "integrators/pass_schedule.h"
#include "lighttree/light_tree.h"
#include "vpl/light_tracing.h"
#include "vpl/vpl_parameters.h"

namespace gradslc {

/// The VPLs of a method, and the tree over them: made anew when a pass belongs to another set.
class VplSource {
 public:
  enum class Structure : std::uint8_t { list, tree };
  explicit VplSource(Structure structure) : structure_(structure) {}

  void describe(ParameterVisitor& visitor);
  /// Measures the bound b from a pilot set of its own seed, so that it does not come from a set that it weights.
  void prepare(const Scene& scene, const RenderSettings& settings);
  /// From the number of VPLs that a pilot set's paths leave.
  MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings) const;
  /// VPLs of the pass's set; nodes only with Structure::tree.
  const LightTree& vpls_of(const PassSlot& slot);

  const VplParameters& parameters() const { return parameters_; }
  float bound() const { return bound_; }
  bool has_vpls_on_emitters() const { return has_vpls_on_emitters_; }
  std::uint64_t sets() const { return sets_; }  ///< made so far: another number, another set
  IntegratorTraits traits() const;
  std::uint64_t rays() const { return rays_; }
  void append_counters(std::vector<IntegratorStatistics::Counter>& counters) const;

 private:
  LightTracingSettings tracing_settings(const Scene& scene, const RenderSettings& settings, SeedPurpose purpose,
                                        int half, std::uint32_t set) const;
  VplSet trace(const LightTracingSettings& tracing);

  Structure structure_;
  VplParameters parameters_;
  std::size_t builder_ = 0;
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  bool has_vpls_on_emitters_ = false;
  float bound_ = 0;
  LightTree tree_;
  bool has_set_ = false;
  int half_ = 0;
  std::uint32_t set_ = 0;
  std::uint64_t rays_ = 0, sets_ = 0, vpls_ = 0;
  double trace_seconds_ = 0, build_seconds_ = 0;
};

}  // namespace gradslc
