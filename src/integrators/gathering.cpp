#include "integrators/gathering.h"

#include <algorithm>

namespace gradslc {
namespace {

/// A vertex that gathers, and what counts of its light.
struct GatherSite {
  const PathVertex& x;
  LabelledThroughput throughput;  ///< of the path up to x
  const Compensation* left_over;  ///< of the connection to x, where x lies behind a ray itself; otherwise null
  int max_edges;
  float rays_per_estimate = 1;  ///< mean number of rays over that of next-event estimates
};

/// Which emitters the ray looks for.
struct EmitterSearch {
  bool within_reach = false;  ///< area lights that have VPLs: where K can exceed b
  bool anywhere = false;      ///< those that next-event estimation at x chooses among
};

EmitterSearch emitter_search(const PathContext& context, const GatherSite& site, const GatherSettings& gather) {
  if (!connection_may_count(context, site.x.edges + 1, site.max_edges)) return {};
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

void gather_next_event(PathContext& context, const GatherSite& site, const GatherSettings& gather,
                       PartValues& radiance) {
  add_next_event(context, site.x, context.lobes.only_connectable(), site.max_edges, site.throughput, site.left_over,
                 radiance, gather.next_event, site.rays_per_estimate);
}
void send_ray(PathContext& context, const GatherSite& site, const GatherSettings& gather, const VertexGather& vertices,
              PartValues& radiance);

/// The path goes on from y through the selected lobes, to its end.
void follow_path(PathContext& context, const GatherSite& at_y, const LobeSelection& lobes, PartValues& radiance) {
  Ray next;
  RayOrigin origin;
  LabelledThroughput throughput = at_y.throughput;
  if (scatter(context, at_y.x, lobes, at_y.max_edges, at_y.left_over, throughput, next, origin, radiance))
    trace_path(context, next, origin, throughput, at_y.x.edges, at_y.max_edges, 0, radiance);
}

/// What the ray through f_c(x) brings from y, the next vertex that scatters: f_s(y) with weight 1, f_c(y) with the
/// weight that bounding leaves over.
void add_reflected(PathContext& context, const GatherSite& site, const PathVertex& y, const GatherRay& gathered,
                   const GatherSettings& gather, const VertexGather& vertices, const LabelledThroughput& throughput,
                   PartValues& radiance) {
  const Compensation left_over = compensation_at(y.point, site.x, gathered, gather);
  const bool compensates =
      left_over.factor * y.bsdf.connectable_value_bound(y.wo, context.lobes).max() > left_over.bound;
  const bool has_other = y.bsdf.has(context.lobes.only_other());
  const GatherSite at_y{y, throughput, &left_over, std::min(site.max_edges, y.edges + gather.max_bounces)};
  if (!vertices) {
    if (compensates || has_other) follow_path(context, at_y, context.lobes, radiance);
    return;
  }
  if (has_other) follow_path(context, at_y, context.lobes.only_other(), radiance);
  if (!compensates) return;
  GatherSettings behind = gather;
  behind.next_event = EmitterChoice::all;
  gather_next_event(context, at_y, behind, radiance);
  const LabelledThroughput from_y = throughput.scattered({Rgb(1), Rgb()});
  if (context.log) context.log->begin_vertex_gather(from_y.total());
  from_y.collect(vertices(context, y, left_over, at_y.max_edges), radiance);
  send_ray(context, at_y, behind, vertices, radiance);
}

/// The ray through f_c(x).
void send_ray(PathContext& context, const GatherSite& site, const GatherSettings& gather, const VertexGather& vertices,
              PartValues& radiance) {
  const PathVertex& x = site.x;
  const LobeSelection connectable = context.lobes.only_connectable();
  const EmitterSearch emitters = emitter_search(context, site, gather);
  const bool goes_on = context.settings.components.indirect && x.edges + 1 < site.max_edges && gather.max_bounces > 0 &&
                       (gather.compensate || gather.scene_has_other_lobes);
  if (!emitters.within_reach && !emitters.anywhere && !goes_on) return;

  const auto index = static_cast<std::uint32_t>(x.edges);
  const float u_lobe = x.bsdf.chooses_lobes() ? context.random.get1(Use::compensation_lobe, index) : 0;
  const auto sample = x.bsdf.sample(x.wo, u_lobe, context.random.get2(Use::compensation, index), connectable);
  if (!sample) return;
  const Rgb f_x = x.bsdf.eval(x.wo, sample->direction, connectable);
  const float length = ray_length(sample->direction, f_x, gather, emitters);
  const GatherRay gathered{spawn_ray(x.point, x.to_world(sample->direction), length), *sample, f_x};

  const float left_over = site.left_over ? site.left_over->weight(f_x) : 1;
  auto throughput = site.throughput.scattered({sample->weight * left_over, Rgb()});
  if (throughput.is_black()) return;
  // Emitters are weighted by the densities of all samples of a kind together (Veach 1997, equation 9.8).
  RayOrigin origin{x.point.position, site.rays_per_estimate * sample->pdf_solid_angle, sample->delta};
  Ray ray = gathered.ray;
  int edges = x.edges;
  const auto emission = [&](const std::optional<SurfacePoint>& hit) {
    return gathered_emission(context, x, gathered, gather, origin, hit);
  };
  while (const auto hit = trace_edge(context, ray, emission, edges, site.max_edges, throughput, radiance)) {
    if (!goes_on && !context.scene.has_crossings()) return;
    const PathVertex y = make_path_vertex(context.scene, *hit, -ray.direction, edges);
    if (context.log) log_vertex(context, y, throughput.total());
    if (passes_on(context, y, throughput, ray, origin)) continue;
    if (goes_on) add_reflected(context, site, y, gathered, gather, vertices, throughput, radiance);
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

float reach_of_vertices(const Scene& scene, const GatherSettings& gather, int max_depth) {
  if (!gather.compensate) return 0;
  const float step = compensation_reach(gather.max_pi_f, 1, gather.max_pi_f, gather.bound);
  return std::min(static_cast<float>(max_depth) * step, 2 * scene.bounding_sphere().radius);
}

EffortAllocation::Sample gather_without_vpls(PathContext& context, const CameraPrefix& prefix,
                                             const GatherSettings& gather, PartValues& radiance,
                                             const GatherEffort& effort, const VertexGather& vertices) {
  if (context.log) context.log->begin_gather(prefix.throughput);
  GatherSite site{*prefix.gather, LabelledThroughput::camera_path(prefix.throughput), nullptr,
                  context.settings.max_depth, effort.rays / static_cast<float>(effort.emitters)};
  const SampleStream random = context.random;
  const auto estimates = static_cast<std::uint32_t>(effort.emitters);
  const float emitter_scale = 1 / static_cast<float>(estimates);
  PartValues by_emitters;
  for (std::uint32_t estimate = 0; estimate < estimates; ++estimate) {
    if (estimates > 1) context.random = random.branch(estimate);
    if (context.log) context.log->begin_next_events(emitter_scale);
    gather_next_event(context, site, gather, by_emitters);
  }
  by_emitters *= emitter_scale;

  site.throughput.vpl_part = Part::compensation;
  const float ray_scale = 1 / effort.rays;
  const std::uint32_t rays =
      effort.rays == 1 ? 1 : static_cast<std::uint32_t>(effort.rays + random.get1(Use::ray_count));
  PartValues by_rays;
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    context.random = effort.rays == 1 ? random : random.branch(ray);
    if (context.log) context.log->begin_compensation_ray(ray, ray_scale);
    send_ray(context, site, gather, vertices, by_rays);
  }
  by_rays *= ray_scale;
  context.random = random;
  if (context.log) context.log->end_compensation_rays();
  radiance += by_emitters, radiance += by_rays;
  return {.by_ray = luminance(by_rays.total()), .by_emitters = luminance(by_emitters.total())};
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
