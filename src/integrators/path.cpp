#include "integrators/path.h"

namespace gradslc {

PixelSample make_pixel_sample(const Scene& scene, const RenderSettings& settings, const LobeSelection& lobes,
                              const PassSlot& slot, std::size_t pixel_index, SeedPurpose purpose) {
  const std::uint64_t seed = derive_seed(settings.seed, purpose, slot.half);
  const PathContext context{scene, settings, lobes, SampleStream(settings.sampler, seed, pixel_index, slot.sample)};
  const Pixel pixel = scene.camera().resolution().pixel(pixel_index);
  return {context, film_position(pixel, context.random.get2(Use::pixel))};
}

std::optional<DirectSample> choose_emitter(PathContext& context, const PathVertex& vertex, EmitterChoice choice) {
  const auto index = static_cast<std::uint32_t>(vertex.edges);
  const auto [u, v] = context.random.get_choice(Use::emitter, index);
  return context.scene.emitters().sample_direct(vertex.point.position, u, v, choice);
}

Ray shadow_ray(const SurfacePoint& from, const DirectSample& light) {
  const Point3 start = offset_position(from, light.wi);
  return light.infinite ? Ray{start, light.wi} : segment(start, light.position);
}

bool connection_may_count(const PathContext& context, int edges, int max_edges) {
  if (edges > max_edges) return false;
  const Components& components = context.settings.components;
  if (components.includes(edges)) return true;
  return context.scene.has_crossings() && edges < max_edges && components.includes(edges + 1);
}

Passage count_passage(PathContext& context, Passage passage, int edges) {
  context.rays += static_cast<std::uint64_t>(passage.rays);
  if (!context.settings.components.includes(edges + passage.crossings)) passage.transmittance = Rgb();
  return passage;
}

Passage connect(PathContext& context, const Ray& ray, int edges, int max_edges) {
  return count_passage(context, context.scene.passage(ray, max_edges - edges), edges);
}

void show_surface(PathContext& context, const PathVertex& vertex, bool decided) {
  const Bsdf& bsdf = vertex.bsdf;
  if (!decided &&
      bsdf.energy(vertex.wo, context.lobes.only_connectable()) < bsdf.energy(vertex.wo, context.lobes.only_other()))
    return;
  const float side = vertex.wo.z < 0 ? -1.0f : 1.0f;
  context.features.image->add(context.features.pixel,
                              {bsdf.albedo(), vertex.to_world({0, 0, side}),
                               length(vertex.point.position - context.scene.camera().position())});
  context.features = {};
}

void log_vertex(const PathContext& context, const PathVertex& vertex, Rgb throughput) {
  const float side = vertex.wo.z < 0 ? -1.0f : 1.0f;
  context.log->note(
      happening::Vertex{.edges = vertex.edges,
                        .position = vertex.point.position,
                        .shading_normal = as_normal(vertex.to_world({0, 0, side})),
                        .material = vertex.point.material,
                        .connectable_energy = vertex.bsdf.energy(vertex.wo, context.lobes.only_connectable()),
                        .other_energy = vertex.bsdf.energy(vertex.wo, context.lobes.only_other()),
                        .pass_probability = vertex.bsdf.pass_probability(vertex.wo),
                        .throughput = throughput});
}

void log_next_event(const PathContext& context, const PathVertex& vertex, const DirectSample& light,
                    const Passage& passage, float mis_weight, const PartValues& brought, bool by_parts) {
  happening::NextEvent event{.edges = vertex.edges + 1 + passage.crossings,
                             .direction = light.wi,
                             .radiance = light.radiance,
                             .pdf_solid_angle = light.pdf_solid_angle,
                             .delta = light.delta,
                             .mis_weight = mis_weight,
                             .transmittance = passage.transmittance};
  if (!light.infinite) event.position = light.position;
  context.log->add(event, brought, by_parts);
}

void log_emitter_hit(const PathContext& context, const Ray& ray, const std::optional<SurfacePoint>& hit, int edges,
                     Rgb weighted_radiance, const PartValues& brought, bool by_parts) {
  const Rgb radiance = hit ? emitted_radiance(context, *hit, -ray.direction, RayOrigin())
                           : environment_radiance(context, ray.direction, RayOrigin());
  happening::EmitterHit event{
      .edges = edges, .radiance = radiance, .mis_weight = luminance(weighted_radiance) / luminance(radiance)};
  if (hit) event.position = hit->position;
  context.log->add(event, brought, by_parts);
}

LobeWeights lobe_weights(const PathVertex& vertex, const Vec3& wi, float pdf_solid_angle, const LobeSelection& lobes,
                         const Compensation* compensation) {
  const float cos_over_pdf = std::abs(wi.z) / pdf_solid_angle;
  const Bsdf::Split f = vertex.bsdf.eval_split(vertex.wo, wi, lobes);
  return {f.connectable * (cos_over_pdf * (compensation ? compensation->weight(f.connectable) : 1)),
          f.other * cos_over_pdf};
}

LobeWeights lobe_weights(const PathVertex& vertex, const BsdfSample& sample, const LobeSelection& lobes,
                         const Compensation* compensation) {
  if (sample.delta) return {Rgb(), sample.weight};
  return lobe_weights(vertex, sample.direction, sample.pdf_solid_angle, lobes, compensation);
}

Rgb emitted_radiance(const PathContext& context, const SurfacePoint& hit, const Vec3& wo, const RayOrigin& origin) {
  const Emitters& emitters = context.scene.emitters();
  const Rgb radiance = emitters.radiance(hit, wo);
  if (is_black(radiance) || origin.emission_only_by_hit) return radiance;
  return radiance * power_heuristic(origin.pdf_solid_angle, emitters.pdf_direct(origin.position, hit));
}

Rgb environment_radiance(const PathContext& context, const Vec3& direction, const RayOrigin& origin,
                         EmitterChoice choice) {
  Rgb sum;
  for (const auto& [light, among_all, among_lights] : context.scene.emitters().environments()) {
    const Rgb radiance = light->radiance(direction);
    const float probability = choice == EmitterChoice::all ? among_all : among_lights;
    const float mis = origin.emission_only_by_hit
                          ? 1
                          : power_heuristic(origin.pdf_solid_angle, probability * light->pdf_direct(direction));
    sum += radiance * mis;
  }
  return sum;
}

}  // namespace gradslc
