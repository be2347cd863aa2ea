#include "integrators/gathering.h"

#include <algorithm>

namespace gradslc {
namespace {

/// Which emitters the ray looks for.
struct EmitterSearch {
  bool within_reach = false;  ///< area lights that have VPLs: where K can exceed b
  bool anywhere = false;      ///< those that next-event estimation at x chooses among
};

EmitterSearch emitter_search(const PathContext& context, const PathVertex& x, const GatherSettings& gather) {
  if (!connection_may_count(context, x.edges + 1, context.settings.max_depth)) return {};
  if (gather.next_event == EmitterChoice::all) return {.within_reach = false, .anywhere = true};
  return {.within_reach = gather.compensate, .anywhere = !context.scene.emitters().environments().empty()};
}

/// The ray is cut where nothing beyond can count: no emitter is looked for, no f_s exists, and K cannot exceed b.
/// The factor covers the rounding of the ray's start.
float ray_length(Vec3 wi, Rgb f_x, const GatherSettings& gather, const EmitterSearch& emitters) {
  constexpr float k_margin = 1.001f;
  if (emitters.anywhere || gather.scene_has_other_lobes) return k_infinity;
  return k_margin * compensation_reach(k_pi * max_channel(f_x), wi.z, gather.max_pi_f, gather.bound);
}

/// A ray sampled through f_c(x), and the value of f_c(x) along it.
struct GatherRay {
  Ray ray;
  BsdfSample sample;
  Rgb f_x;
};

/// What bounding leaves over of the connection between x and a lobe at y, which lies on the ray.
Compensation compensation_at(const SurfacePoint& y, const PathVertex& x, const GatherRay& gathered,
                             const GatherSettings& gather) {
  const float factor = connection_strength(k_pi * max_channel(gathered.f_x), 1, gathered.sample.direction.z,
                                           dot(gathered.ray.direction, y.geometric_normal),
                                           distance_squared(x.point.position, y.position));
  return {factor, gather.compensate ? gather.bound : k_infinity};
}

/// Emission at the end of the ray. An area light that has VPLs is a lobe with pi f_c(y) = 1; all other emitters are
/// weighted against next-event estimation.
Rgb gathered_emission(const PathContext& context, const PathVertex& x, const GatherRay& gathered,
                      const GatherSettings& gather, const RayOrigin& origin, const std::optional<SurfacePoint>& hit) {
  const Vec3 wi = gathered.ray.direction;
  if (!hit) return environment_radiance(context, wi, origin, gather.next_event);
  if (gather.next_event == EmitterChoice::all) return emitted_radiance(context, *hit, -wi, origin);
  const Rgb radiance = context.scene.emitters().radiance(*hit, -wi);
  if (is_black(radiance)) return radiance;
  return radiance * compensation_at(*hit, x, gathered, gather).weight(Rgb(k_inv_pi));
}

/// What the ray through f_c(x) brings from y, the next vertex that scatters: f_s(y) with weight 1, f_c(y) with the
/// weight that bounding leaves over.
void add_reflected(PathContext& context, const PathVertex& x, const PathVertex& y, const GatherRay& gathered,
                   const GatherSettings& gather, LabelledThroughput throughput, PartValues& radiance) {
  const Compensation compensation = compensation_at(y.point, x, gathered, gather);
  const bool compensates =
      compensation.factor * y.bsdf.connectable_value_bound(y.wo, context.lobes).max() > compensation.bound;
  if (!compensates && !y.bsdf.has(context.lobes.only_other())) return;
  const int max_edges = std::min(context.settings.max_depth, y.edges + gather.max_bounces);
  Ray next;
  RayOrigin origin;
  if (scatter(context, y, max_edges, &compensation, throughput, next, origin, radiance))
    trace_path(context, next, origin, throughput, y.edges, max_edges, 0, radiance);
}

void add_compensation(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                      PartValues& radiance) {
  const PathVertex& x = *prefix.gather;
  const LobeSelection connectable = context.lobes.only_connectable();
  const int max_depth = context.settings.max_depth;
  const EmitterSearch emitters = emitter_search(context, x, gather);
  const bool goes_on = context.settings.components.indirect && x.edges + 1 < max_depth && gather.max_bounces > 0 &&
                       (gather.compensate || gather.scene_has_other_lobes);
  if (!emitters.within_reach && !emitters.anywhere && !goes_on) return;

  const auto index = static_cast<std::uint32_t>(x.edges);
  const float u_lobe = x.bsdf.chooses_lobes() ? context.random.get1(Use::compensation_lobe, index) : 0;
  const auto sample = x.bsdf.sample(x.wo, u_lobe, context.random.get2(Use::compensation, index), connectable);
  if (!sample) return;
  const Rgb f_x = x.bsdf.eval(x.wo, sample->direction, connectable);
  const float length = ray_length(sample->direction, f_x, gather, emitters);
  const GatherRay gathered{spawn_ray(x.point, x.to_world(sample->direction), length), *sample, f_x};

  auto throughput =
      LabelledThroughput::camera_path(prefix.throughput, Part::compensation).scattered({sample->weight, Rgb()});
  RayOrigin origin{x.point.position, sample->pdf_solid_angle, sample->delta};
  Ray ray = gathered.ray;
  int edges = x.edges;
  const auto emission = [&](const std::optional<SurfacePoint>& hit) {
    return gathered_emission(context, x, gathered, gather, origin, hit);
  };
  while (const auto hit = trace_edge(context, ray, emission, edges, max_depth, throughput, radiance)) {
    if (!goes_on && !context.scene.has_crossings()) return;
    const PathVertex y = make_path_vertex(context.scene, *hit, -ray.direction, edges);
    if (passes_on(context, y, throughput, ray, origin)) continue;
    if (goes_on) add_reflected(context, x, y, gathered, gather, throughput, radiance);
    return;
  }
}

}  // namespace

GatherSettings make_gather_settings(const Scene& scene, const VplParameters& parameters, float bound, int max_depth) {
  GatherSettings gather;
  const LobeSelection lobes = parameters.lobes();
  gather.compensate = parameters.bounding == Bounding::compensate;
  gather.bound = parameters.bounding == Bounding::none ? k_infinity : bound;
  gather.max_bounces = parameters.resolved_max_bounces(max_depth);
  gather.next_event = parameters.direct ? EmitterChoice::without_area_lights : EmitterChoice::all;
  gather.max_pi_f = parameters.direct ? 1 : 0;
  for (const MaterialPtr& material : scene.materials()) {
    gather.scene_has_other_lobes |= material->has_other_lobes(lobes);
    gather.max_pi_f = std::max(gather.max_pi_f, material->max_connectable_pi_f(lobes));
  }
  return gather;
}

float gather_without_vpls(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                          PartValues& radiance, float mean_rays) {
  add_next_event(context, *prefix.gather, context.lobes.only_connectable(), context.settings.max_depth,
                 LabelledThroughput::camera_path(prefix.throughput), nullptr, radiance, gather.next_event);
  PartValues brought;
  if (mean_rays == 1) {
    add_compensation(context, prefix, gather, brought);
  } else {
    const auto count = static_cast<std::uint32_t>(mean_rays + context.random.get1(Use::ray_count));
    const SampleStream random = context.random;
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      context.random = random.branch(ray);
      add_compensation(context, prefix, gather, brought);
    }
    context.random = random;
    brought *= 1 / mean_rays;
  }
  radiance += brought;
  return luminance(brought.total());
}

}  // namespace gradslc
