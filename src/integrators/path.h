#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "film/feature_image.h"
#include "integrators/integrator.h"
#include "integrators/pass_schedule.h"
#include "integrators/path_log.h"
#include "integrators/throughput.h"
#include "scene/scene.h"
#include "vpl/bounding.h"

namespace gradslc {

/// What every path of one sample shares.
struct PathContext {
  const Scene& scene;
  const RenderSettings& settings;
  LobeSelection lobes;
  SampleStream random;
  std::uint64_t rays = 0;  ///< counted here
  PathLog* log = nullptr;  ///< is told what happens, if there is one
  FeatureSink features;    ///< is told the surface that the path shows; emptied then
};

/// A pixel's sample with random numbers of its own, as methods without groups take it: jittered within the pixel.
struct PixelSample {
  PathContext context;
  Vec2 film_position;
};
PixelSample make_pixel_sample(const Scene& scene, const RenderSettings& settings, const LobeSelection& lobes,
                              const PassSlot& slot, std::size_t pixel_index, SeedPurpose purpose = SeedPurpose::camera);

/// The film position at `offset` from a pixel's upper left corner.
inline Vec2 film_position(Pixel pixel, Vec2 offset) {
  return Vec2{static_cast<float>(pixel.x), static_cast<float>(pixel.y)} + offset;
}

/// Power heuristic with exponent 2 (Veach 1997, section 9.2.4): weight of the technique with density `pdf`, both in the
/// same measure. Ratios first, so that large densities do not overflow.
inline float power_heuristic(float pdf, float other_pdf) {
  if (pdf <= 0) return 0;
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// How a ray was made: what weighs the emitter that it may hit against next-event estimation.
struct RayOrigin {
  Point3 position;            ///< of the last vertex that scatters
  float pdf_solid_angle = 0;  ///< with which the ray's direction was sampled, and all crossings since were passed
  bool emission_only_by_hit = true;  ///< camera rays and delta lobes: next-event estimation cannot find the emitter
};

/// At the first vertex y of a path, f_c(y) counts only with the weight that bounded gathering leaves over (DESIGN 4):
/// strength K = `factor` * pi f_c(y), for each direction in which y goes on.
struct Compensation {
  float factor;  ///< pi f_c(x) |cos_x cos_y| / d^2
  float bound;   ///< b

  float weight(Rgb f_y) const { return compensation_weight(factor * k_pi * max_channel(f_y), bound); }
};

/// A point of a path. One that the path passes straight through, a crossing, counts for the edges and is no scattering
/// event (DESIGN 2).
struct PathVertex : ShadedPoint {
  int edges = 0;  ///< of the path from the camera up to here
};
inline PathVertex make_path_vertex(const Scene& scene, const SurfacePoint& hit, const Vec3& wo, int edges) {
  PathVertex vertex;
  scene.shade(hit, wo, vertex);
  vertex.edges = edges;
  return vertex;
}

/// `decided`: whatever its lobes.
void show_surface(PathContext& context, const PathVertex& vertex, bool decided);
/// A camera path comes to a vertex that scatters it. It shows the first surface that scatters at least half of the
/// light by connectable lobes; mirrors and glass show what is behind them.
inline void show(PathContext& context, const PathVertex& vertex) {
  if (context.features.image) show_surface(context, vertex, false);
}

/// Chooses a point on an emitter by the numbers of `vertex.edges`; nullopt if it cannot light the vertex. Visibility is
/// not tested.
std::optional<DirectSample> choose_emitter(PathContext& context, const PathVertex& vertex,
                                           EmitterChoice choice = EmitterChoice::all);
/// The shadow ray of that choice.
Ray shadow_ray(const SurfacePoint& from, const DirectSample& light);

/// Whether light can count over a path whose last connection makes `edges` edges of it (>= 2, at most `max_edges`
/// count), and one more for each crossing on it.
bool connection_may_count(const PathContext& context, int edges, int max_edges);
/// Counts the rays of a connection's passage; makes it black where the path with its crossings does not count.
/// `edges`: without crossings.
Passage count_passage(PathContext& context, Passage passage, int edges);
/// What gets along the connection; black where nothing does, or where the path with its crossings does not count.
/// `edges`: without crossings, at most max_edges.
Passage connect(PathContext& context, const Ray& ray, int edges, int max_edges);
/// Share of light that gets along the segment between a camera path's vertex and a light path's; black where it is
/// blocked, or where the whole path does not count. `edges`: D = p + 1 + k of the path without the segment's crossings,
/// at most settings.max_depth.
inline Rgb connection_transmittance(PathContext& context, const Ray& segment, int edges) {
  return connect(context, segment, edges, context.settings.max_depth).transmittance;
}

// What the context's log is told. Only where there is one; `brought` is what was added to the path's radiance.
void log_vertex(const PathContext& context, const PathVertex& vertex, Rgb throughput);
void log_next_event(const PathContext& context, const PathVertex& vertex, const DirectSample& light,
                    const Passage& passage, float mis_weight, const PartValues& brought, bool by_parts);
void log_emitter_hit(const PathContext& context, const Ray& ray, const std::optional<SurfacePoint>& hit, int edges,
                     Rgb weighted_radiance, const PartValues& brought, bool by_parts);

/// Splits the value of the selected lobes towards wi; each times |cos| over pdf.
LobeWeights lobe_weights(const PathVertex& vertex, const Vec3& wi, float pdf_solid_angle, const LobeSelection& lobes,
                         const Compensation* compensation);
/// The same for a sampled direction.
LobeWeights lobe_weights(const PathVertex& vertex, const BsdfSample& sample, const LobeSelection& lobes,
                         const Compensation* compensation);

/// What light that arrives through a throughput adds to the path's radiance.
template <class Throughput>
PartValues brought_through(const Throughput& throughput, Rgb radiance) {
  PartValues brought;
  throughput.collect(radiance, brought);
  return brought;
}

/// Next-event estimation at a vertex, through crossings, with multiple importance sampling against a ray sampled from
/// the same lobes: adds to `radiance` what counts of paths with at most `max_edges` edges. `rays`: such rays for each
/// estimate.
template <class Throughput>
void add_next_event(PathContext& context, const PathVertex& vertex, const LobeSelection& lobes, int max_edges,
                    const Throughput& throughput, const Compensation* compensation, PartValues& radiance,
                    EmitterChoice choice = EmitterChoice::all, float rays = 1) {
  if (!connection_may_count(context, vertex.edges + 1, max_edges)) return;
  const auto light = choose_emitter(context, vertex, choice);
  if (!light) return;
  const Vec3 wi = vertex.to_local(light->wi);
  const float pdf = light->pdf_solid_angle;
  const Throughput scattered = throughput.scattered(lobe_weights(vertex, wi, pdf, lobes, compensation));
  if (scattered.is_black()) return;
  const Passage passage = connect(context, shadow_ray(vertex.point, *light), vertex.edges + 1, max_edges);
  if (is_black(passage.transmittance)) {
    if (context.log) log_next_event(context, vertex, *light, passage, 0, PartValues(), Throughput::k_by_lobes);
    return;
  }
  // The sampled ray reaches the emitter if it also passes all crossings.
  const float mis =
      light->delta
          ? 1
          : power_heuristic(pdf, rays * vertex.bsdf.pdf_solid_angle(vertex.wo, wi, lobes) * passage.probability);
  const Throughput arriving = scattered.transmitted(passage.transmittance).scaled(mis);
  arriving.collect(light->radiance, radiance);
  if (context.log)
    log_next_event(context, vertex, *light, passage, mis, brought_through(arriving, light->radiance),
                   Throughput::k_by_lobes);
}

/// Radiance of an emitter at `hit` towards the ray's origin, weighted against next-event estimation.
Rgb emitted_radiance(const PathContext& context, const SurfacePoint& hit, const Vec3& wo, const RayOrigin& origin);
/// The same for a ray that leaves the scene in `direction`. `choice`: of next-event estimation at the origin.
Rgb environment_radiance(const PathContext& context, const Vec3& direction, const RayOrigin& origin,
                         EmitterChoice choice = EmitterChoice::all);

/// Traces a path's next edge, counts it in `edges` and adds what an emitter at its end brings: `emission`(hit), of an
/// optional SurfacePoint, weighted. The surface there; nullopt where the path ends, at the latest with `max_edges`
/// edges.
template <class Throughput, class Emission>
std::optional<SurfacePoint> trace_edge(PathContext& context, const Ray& ray, const Emission& emission, int& edges,
                                       int max_edges, const Throughput& throughput, PartValues& radiance) {
  if (edges >= max_edges) return std::nullopt;
  ++context.rays;
  ++edges;
  auto hit = context.scene.intersect(ray);
  if (context.settings.components.includes(edges)) {
    const Rgb emitted = emission(hit);
    throughput.collect(emitted, radiance);
    if (context.log && !is_black(emitted))
      log_emitter_hit(context, ray, hit, edges, emitted, brought_through(throughput, emitted), Throughput::k_by_lobes);
  }
  if (edges == max_edges) hit.reset();
  return hit;
}
/// The same, emission weighted against next-event estimation among all emitters.
template <class Throughput>
std::optional<SurfacePoint> next_hit(PathContext& context, const Ray& ray, const RayOrigin& origin, int& edges,
                                     int max_edges, const Throughput& throughput, PartValues& radiance) {
  const auto emission = [&](const std::optional<SurfacePoint>& hit) {
    return hit ? emitted_radiance(context, *hit, -ray.direction, origin)
               : environment_radiance(context, ray.direction, origin);
  };
  return trace_edge(context, ray, emission, edges, max_edges, throughput, radiance);
}

/// Draws whether a path passes straight through the surface that it has come to (Bsdf::pass_probability()): then its
/// ray goes on behind, and `origin` stays the last vertex that scattered. False: it is to be scattered there.
template <class Throughput>
bool passes_on(const PathContext& context, const PathVertex& vertex, Throughput& throughput, Ray& ray,
               RayOrigin& origin) {
  const float pass = vertex.bsdf.pass_probability(vertex.wo);
  if (pass == 0) return false;
  if (context.random.get1(Use::crossing, static_cast<std::uint32_t>(vertex.edges)) >= pass) {
    throughput = throughput.scaled(1 / (1 - pass));
    return false;
  }
  if (context.log) context.log->note(happening::Crossing{});
  throughput = throughput.transmitted(vertex.bsdf.straight_transmittance() / pass);
  origin.pdf_solid_angle *= pass;
  ray = pass_on(ray, vertex.point);
  return true;
}

/// Next-event estimation at a vertex through the selected lobes, then a sampled direction: updates throughput, ray and
/// origin. False: the path ends.
template <class Throughput>
bool scatter(PathContext& context, const PathVertex& vertex, const LobeSelection& lobes, int max_edges,
             const Compensation* compensation, Throughput& throughput, Ray& ray, RayOrigin& origin,
             PartValues& radiance) {
  add_next_event(context, vertex, lobes, max_edges, throughput, compensation, radiance);

  const auto index = static_cast<std::uint32_t>(vertex.edges);
  const float u_lobe = vertex.bsdf.chooses_lobes() ? context.random.get1(Use::lobe, index) : 0;
  const auto sample = vertex.bsdf.sample(vertex.wo, u_lobe, context.random.get2(Use::direction, index), lobes);
  if (!sample) return false;
  if (Throughput::k_by_lobes || compensation)
    throughput = throughput.scattered(lobe_weights(vertex, *sample, lobes, compensation));
  else
    throughput = throughput.scattered({sample->weight, Rgb()});
  if (throughput.is_black()) return false;
  ray = spawn_ray(vertex.point, vertex.to_world(sample->direction));
  origin.position = vertex.point.position;
  origin.pdf_solid_angle = sample->pdf_solid_angle;
  origin.emission_only_by_hit = sample->delta;
  return true;
}

/// Russian roulette by throughput; scales it up on survival.
template <class Throughput>
bool survives(const PathContext& context, int edges, Throughput& throughput) {
  const float survival = std::min(1.0f, throughput.largest());
  if (context.random.get1(Use::roulette, static_cast<std::uint32_t>(edges)) >= survival) return false;
  throughput = throughput.scaled(1 / survival);
  return true;
}

/// Follows a path from `ray` to its end, adding all light that arrives with at most `max_edges` edges in components
/// that count. `edges`: of the path so far, not counting `ray`. Path tracing with next-event estimation (Kajiya 1986)
/// and multiple importance sampling, without Russian roulette before `roulette_depth` edges (0: never).
template <class Throughput>
void trace_path(PathContext& context, Ray ray, RayOrigin origin, Throughput throughput, int edges, int max_edges,
                int roulette_depth, PartValues& radiance) {
  while (const auto hit = next_hit(context, ray, origin, edges, max_edges, throughput, radiance)) {
    const PathVertex vertex = make_path_vertex(context.scene, *hit, -ray.direction, edges);
    if (context.log) log_vertex(context, vertex, throughput.total());
    if (passes_on(context, vertex, throughput, ray, origin)) continue;
    show(context, vertex);
    if (!scatter(context, vertex, context.lobes, max_edges, nullptr, throughput, ray, origin, radiance)) return;
    if (roulette_depth > 0 && edges >= roulette_depth && !survives(context, edges, throughput)) return;
  }
}

}  // namespace gradslc
