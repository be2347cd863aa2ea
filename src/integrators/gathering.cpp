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

void add_compensation(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                      PartValues& radiance) {
  const PathVertex& x = *prefix.gather;
  const LobeSelection connectable = context.lobes.only_connectable();
  const int edges = x.edges + 1, max_depth = context.settings.max_depth;
  const bool looks_for_emitters = connection_may_count(context, edges, max_depth);
  const bool goes_on = context.settings.components.indirect && edges < max_depth && gather.max_bounces > 0 &&
                       (gather.compensate || gather.scene_has_other_lobes);
  if (!looks_for_emitters && !goes_on) return;

  const auto index = static_cast<std::uint32_t>(x.edges);
  const float u_lobe = context.random.get1(Use::compensation_lobe, index);
  const auto sample = x.bsdf.sample(x.wo, u_lobe, context.random.get2(Use::compensation, index), connectable);
  if (!sample) return;
  const Rgb f_x = x.bsdf.eval(x.wo, sample->direction, connectable);
  const Vec3 wi = x.to_world(sample->direction);
  const Ray ray = spawn_ray(x.point, wi, ray_length(sample->direction, f_x, gather, looks_for_emitters));
  auto throughput =
      LabelledThroughput::camera_path(prefix.throughput, Part::compensation).scattered({sample->weight, Rgb()});
  RayOrigin origin{x.point.position, sample->pdf_solid_angle, sample->delta};
  const auto y = next_vertex(context, ray, origin, x.edges, max_depth, throughput, radiance);
  if (!y || !goes_on) return;

  const Compensation compensation{
      connection_strength(k_pi * max_channel(f_x), 1, sample->direction.z, dot(wi, y->point.geometric_normal),
                          distance_squared(x.point.position, y->point.position)),
      gather.compensate ? gather.bound : k_infinity};
  const bool compensates =
      compensation.factor * y->bsdf.max_connectable_pi_f(y->wo, context.lobes) > compensation.bound;
  if (!compensates && !y->bsdf.has(context.lobes.only_other())) return;
  const int max_edges = std::min(max_depth, y->edges + gather.max_bounces);
  Ray next;
  if (scatter(context, *y, max_edges, &compensation, throughput, next, origin, radiance))
    trace_path(context, next, origin, throughput, y->edges, max_edges, 0, radiance);
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

void gather_without_vpls(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                         PartValues& radiance) {
  add_next_event(context, *prefix.gather, context.lobes.only_connectable(), context.settings.max_depth,
                 LabelledThroughput::camera_path(prefix.throughput), nullptr, radiance);
  add_compensation(context, prefix, gather, radiance);
}

}  // namespace gradslc
