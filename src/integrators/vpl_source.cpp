#include "integrators/vpl_source.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "vpl/density.h"

namespace gradslc {

void VplSource::describe(ParameterVisitor& v) {
  v.group("vpl", "virtual point lights", [&] { gradslc::describe(v, parameters_); });
  if (structure_ == Structure::tree) v.choice("builder", builder_, builder_names(), "how the light tree is built");
}

void VplSource::prepare(const Scene& scene, const RenderSettings& settings) {
  scene_ = &scene, settings_ = settings;
  if (parameters_.bounding == Bounding::none) return;
  bound_ = static_cast<float>(parameters_.bound);
  if (bound_ > 0) return;
  const VplSet pilot = trace(SeedPurpose::pilot, 0, 0);
  bound_ = static_cast<float>(automatic_bound(pilot.vpls, parameters_.kappa));
  if (!(bound_ > 0)) bound_ = k_infinity;  // no VPLs to speak of: their connections are not bounded
}

LightTracingSettings VplSource::tracing_settings(const RenderSettings& settings, SeedPurpose purpose, int half,
                                                 std::uint32_t set) const {
  constexpr std::int64_t k_most_pilot_paths = 10000;
  const std::int64_t paths = parameters_.light_paths;
  return {.light_paths = purpose == SeedPurpose::pilot ? std::min(paths, k_most_pilot_paths) : paths,
          .max_bounces = std::min(parameters_.resolved_max_bounces(settings.max_depth), settings.max_depth - 2),
          .lobes = parameters_.lobes(),
          .sampler = settings.sampler,
          .seed = derive_seed(settings.seed, purpose, half),
          .set = set};
}

MemoryPlan VplSource::plan_memory(const Scene& scene, const RenderSettings& settings) const {
  const LightTracingSettings tracing = tracing_settings(settings, SeedPurpose::pilot, 0, 0);
  const VplSet pilot = trace_vpls(scene, tracing);
  const double scale = static_cast<double>(parameters_.light_paths) / static_cast<double>(tracing.light_paths);
  const VplCounts counts{scale * static_cast<double>(pilot.vpls.size()),
                         scale * static_cast<double>(pilot.surfaces.size())};
  MemoryPlan plan{static_cast<double>(parameters_.light_paths), counts.vpls, counts.bytes(), counts.bytes()};
  if (structure_ == Structure::tree) {
    const BuilderEntry& builder = builder_registry()[builder_];
    plan.resident_bytes = builder.resident_bytes(counts), plan.peak_bytes = builder.peak_bytes(counts);
  }
  return plan;
}

VplSet VplSource::trace(SeedPurpose purpose, int half, std::uint32_t set) {
  const LightTracingSettings tracing = tracing_settings(settings_, purpose, half, set);
  const Stopwatch watch;
  VplSet traced = trace_vpls(*scene_, tracing);
  trace_seconds_ += watch.seconds();
  rays_ += traced.rays;
  return traced;
}

const LightTree& VplSource::vpls_of(const PassSlot& slot) {
  const int half = parameters_.passes_per_set == 0 ? 0 : slot.half;
  if (has_set_ && half_ == half && set_ == slot.set) return tree_;
  tree_ = LightTree();
  VplSet traced = trace(SeedPurpose::light_paths, half, slot.set);
  ++sets_, vpls_ += traced.vpls.size();
  const Stopwatch watch;
  if (structure_ == Structure::tree)
    tree_ = builder_registry()[builder_].build(std::move(traced));
  else
    tree_.set = std::move(traced);
  build_seconds_ += watch.seconds();
  has_set_ = true, half_ = half, set_ = slot.set;
  return tree_;
}

IntegratorTraits VplSource::traits() const {
  return {.gradients = false,
          .biased = parameters_.bounding == Bounding::clamp,
          .truncated = parameters_.resolved_max_bounces(settings_.max_depth) < settings_.max_depth - 2,
          .one_set = parameters_.passes_per_set == 0};
}

void VplSource::append_counters(std::vector<IntegratorStatistics::Counter>& counters) const {
  counters.push_back({"vpl_sets", static_cast<double>(sets_)});
  counters.push_back({"vpls_per_set", sets_ > 0 ? static_cast<double>(vpls_) / static_cast<double>(sets_) : 0});
  counters.push_back({"vpl_bound", static_cast<double>(bound_)});
  counters.push_back({"light_rays", static_cast<double>(rays_)});
  counters.push_back({"trace_seconds", trace_seconds_});
  counters.push_back({"build_seconds", build_seconds_});
}

}  // namespace gradslc
