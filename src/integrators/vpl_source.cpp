#include "integrators/vpl_source.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "vpl/density.h"

namespace gradslc {
namespace {

/// Whether a path from a VPL on an emitter (k = 0) to any gather vertex may count: D is 2, or more by vertices before x
/// or crossings.
bool vpls_on_emitters_may_count(const Scene& scene, const RenderSettings& settings, const LobeSelection& lobes) {
  const auto has_other_lobes = [&](const MaterialPtr& material) { return material->has_other_lobes(lobes); };
  if (settings.components.direct && settings.max_depth >= 2) return true;
  return settings.components.indirect && settings.max_depth >= 3 &&
         (scene.has_crossings() || std::any_of(scene.materials().begin(), scene.materials().end(), has_other_lobes));
}

}  // namespace

void VplSource::describe(ParameterVisitor& v) {
  v.group("vpl", "virtual point lights", [&] { gradslc::describe(v, parameters_); });
  if (structure_ == Structure::tree) v.choice("builder", builder_, builder_names(), "how the light tree is built");
}

void VplSource::prepare(const Scene& scene, const RenderSettings& settings) {
  scene_ = &scene, settings_ = settings;
  has_set_ = false;
  LightTracingSettings pilot_tracing = tracing_settings(scene, settings, SeedPurpose::pilot, 0, 0);
  has_vpls_on_emitters_ = pilot_tracing.on_emitters;
  if (parameters_.bounding == Bounding::none) return;
  bound_ = static_cast<float>(parameters_.bound);
  if (bound_ > 0) return;
  // Lamps hold their VPLs so densely that the mean over all would leave connections to walls unbounded.
  if (pilot_tracing.max_bounces > 0) pilot_tracing.on_emitters = false;
  const VplSet pilot = trace(pilot_tracing);
  bound_ = static_cast<float>(automatic_bound(pilot.vpls, parameters_.kappa));
  if (!(bound_ > 0)) bound_ = k_infinity;  // no VPLs to speak of: their connections are not bounded
}

LightTracingSettings VplSource::tracing_settings(const Scene& scene, const RenderSettings& settings,
                                                 SeedPurpose purpose, int half, std::uint32_t set) const {
  constexpr std::int64_t k_most_pilot_paths = 10000;
  const std::int64_t paths = parameters_.light_paths;
  const bool on_emitters = parameters_.direct && vpls_on_emitters_may_count(scene, settings, parameters_.lobes());
  // Without indirect light no other VPL counts, and none may take up samples.
  const int deepest = on_emitters && !settings.components.indirect ? 0 : settings.max_depth - 2;
  return {.light_paths = purpose == SeedPurpose::pilot ? std::min(paths, k_most_pilot_paths) : paths,
          .max_bounces = std::min(parameters_.resolved_max_bounces(settings.max_depth), deepest),
          .on_emitters = on_emitters,
          .lobes = parameters_.lobes(),
          .sampler = settings.sampler,
          .seed = derive_seed(settings.seed, purpose, half),
          .set = set};
}

MemoryPlan VplSource::plan_memory(const Scene& scene, const RenderSettings& settings) const {
  const LightTracingSettings tracing = tracing_settings(scene, settings, SeedPurpose::pilot, 0, 0);
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

VplSet VplSource::trace(const LightTracingSettings& tracing) {
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
  VplSet traced = trace(tracing_settings(*scene_, settings_, SeedPurpose::light_paths, half, slot.set));
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
