#include "integrators/gathering.h"

#include <algorithm>

namespace gradslc {
namespace {

/// The ray is cut where nothing beyond can count: no emitter is looked for, no f_s exists, and K cannot exceed b.
/// The factor covers the rounding of the ray's start.
float ray_length(Vec3 wi, Rgb f_x, const GatherSettings& gather, bool looks_for_emitters) {
  constexpr float k_margin = 1.001f;
  if (looks_for_emitters || gather.scene_has_other_lobes) return k_infinity;
  return k_margin * compensation_reach(k_pi * max_channel(f_x), wi.z, gather.max_pi_f, gather.bound);
}

/// A ray sampled through f_c(x), and the value of f_c(x) along it.
struct GatherRay {
  Ray ray;
  BsdfSample sample;
  Rgb f_x;
};

/// What the ray through f_c(x) brings from y, the next vertex that scatters: f_s(y) with weight 1, f_c(y) with the
/// weight that bounding leaves over.
void add_reflected(PathContext& context, const PathVertex& x, const PathVertex& y, const GatherRay& gathered,
                   const GatherSettings& gather, LabelledThroughput throughput, PartValues& radiance) {
  const Compensation compensation{connection_strength(k_pi * max_channel(gathered.f_x), 1, gathered.sample.direction.z,
                                                      dot(gathered.ray.direction, y.point.geometric_normal),
                                                      distance_squared(x.point.position, y.point.position)),
                                  gather.compensate ? gather.bound : k_infinity};
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
  const bool looks_for_emitters = connection_may_count(context, x.edges + 1, max_depth);
  const bool goes_on = context.settings.components.indirect && x.edges + 1 < max_depth && gather.max_bounces > 0 &&
                       (gather.compensate || gather.scene_has_other_lobes);
  if (!looks_for_emitters && !goes_on) return;

  const auto index = static_cast<std::uint32_t>(x.edges);
  const float u_lobe = context.random.get1(Use::compensation_lobe, index);
  const auto sample = x.bsdf.sample(x.wo, u_lobe, context.random.get2(Use::compensation, index), connectable);
  if (!sample) return;
  const Rgb f_x = x.bsdf.eval(x.wo, sample->direction, connectable);
  const float length = ray_length(sample->direction, f_x, gather, looks_for_emitters);
  const GatherRay gathered{spawn_ray(x.point, x.to_world(sample->direction), length), *sample, f_x};

  auto throughput =
      LabelledThroughput::camera_path(prefix.throughput, Part::compensation).scattered({sample->weight, Rgb()});
  RayOrigin origin{x.point.position, sample->pdf_solid_angle, sample->delta};
  Ray ray = gathered.ray;
  int edges = x.edges;
  while (const auto hit = next_hit(context, ray, origin, edges, max_depth, throughput, radiance)) {
    if (!goes_on && !context.scene.has_crossings()) return;
    const PathVertex y = make_path_vertex(context.scene, *hit, -ray.direction, edges);
    if (context.log) log_vertex(context, y, throughput.total());
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
  gather.max_pi_f = 0;
  for (const MaterialPtr& material : scene.materials()) {
    gather.scene_has_other_lobes |= material->has_other_lobes(lobes);
    gather.max_pi_f = std::max(gather.max_pi_f, material->max_connectable_pi_f(lobes));
  }
  return gather;
}

float gather_without_vpls(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                          PartValues& radiance, float mean_rays) {
  if (context.log) context.log->begin_gather(prefix.throughput);
  add_next_event(context, *prefix.gather, context.lobes.only_connectable(), context.settings.max_depth,
                 LabelledThroughput::camera_path(prefix.throughput), nullptr, radiance);
  PartValues brought;
  if (mean_rays == 1) {
    if (context.log) context.log->begin_compensation_ray(0, 1);
    add_compensation(context, prefix, gather, brought);
  } else {
    const auto count = static_cast<std::uint32_t>(mean_rays + context.random.get1(Use::ray_count));
    const SampleStream random = context.random;
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      context.random = random.branch(ray);
      if (context.log) context.log->begin_compensation_ray(ray, 1 / mean_rays);
      add_compensation(context, prefix, gather, brought);
    }
    context.random = random;
    brought *= 1 / mean_rays;
  }
  if (context.log) context.log->end_compensation_rays();
  radiance += brought;
  return luminance(brought.total());
}

void log_connection(const PathContext& context, const PathVertex& x, const VplView& vpls, std::uint32_t vpl,
                    float bound, Rgb unshadowed, Rgb transmittance, float weight,
                    std::optional<float> candidate_weight) {
  const Vpl& y = vpls[vpl];
  const GatherPoint point{x, context.lobes};
  const float bounded = luminance(unshadowed_contribution(point, vpls, y, bound));
  const float plain = luminance(unshadowed_contribution(point, vpls, y, k_infinity));
  happening::VplConnection connection{.vpl = vpl,
                                      .vertex = y.vertex,
                                      .edges = connection_edges(x, y),
                                      .position = y.position,
                                      .distance = std::sqrt(distance_squared(x.point.position, y.position)),
                                      .unshadowed = unshadowed,
                                      .transmittance = transmittance,
                                      .bounded_weight = plain > 0 ? bounded / plain : 1,
                                      .weight = weight,
                                      .candidate_weight = candidate_weight};
  if (!y.is_lambert()) connection.material = vpls.set.surfaces[y.surface].material;
  context.log->add_vpl(connection);
}

}  // namespace gradslc
