#include "integrators/vpl_source.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "vpl/density.h"
#include "vpl/light_tracing.h"

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
  constexpr std::int64_t k_most_pilot_paths = 10000;
  const VplSet pilot = trace(std::min(parameters_.light_paths, k_most_pilot_paths), SeedPurpose::pilot, 0, 0);
  bound_ = static_cast<float>(automatic_bound(pilot.vpls, parameters_.kappa));
  if (!(bound_ > 0)) bound_ = k_infinity;  // no VPLs to speak of: their connections are not bounded
}

VplSet VplSource::trace(std::int64_t light_paths, SeedPurpose purpose, int half, std::uint32_t set) {
  const LightTracingSettings tracing{
      .light_paths = light_paths,
      .max_bounces = std::min(parameters_.resolved_max_bounces(settings_.max_depth), settings_.max_depth - 2),
      .lobes = parameters_.lobes(),
      .sampler = settings_.sampler,
      .seed = derive_seed(settings_.seed, purpose, half),
      .set = set};
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
  VplSet traced = trace(parameters_.light_paths, SeedPurpose::light_paths, half, slot.set);
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
  counters.push_back({"trace_seconds", trace_seconds_});
  counters.push_back({"build_seconds", build_seconds_});
}

}  // namespace gradslc
