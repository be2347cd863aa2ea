#include "scene/emitters.h"

#include <cassert>
#include <cmath>

#include "core/warp.h"
#include "scene/lights/bounding_disk.h"

namespace gradslc {
namespace {

/// A density per area as one per solid angle: times distance^2 / cosine at the emitter, whose normal is `n`; 0 where it
/// does not face the reference.
float to_solid_angle(double pdf_area, const Normal3& n, const Vec3& to_reference, float distance) {
  const float projected = dot(n, to_reference);  // distance times cosine
  if (!(projected > 0)) return 0;
  const auto pdf = static_cast<float>(pdf_area * static_cast<double>(distance * distance * (distance / projected)));
  return pdf < k_infinity ? pdf : 0;
}

}  // namespace

Emitters::Emitters(const std::vector<TriangleMesh>& meshes, const std::vector<AreaLight>& area_lights,
                   const std::vector<LightPtr>& lights, const EmissionExtent& extent)
    : mesh_first_(meshes.size(), k_no_emitter), extent_(extent) {
  std::vector<double> weights;
  double power[3] = {0, 0, 0};
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const TriangleMesh& mesh = meshes[m];
    if (mesh.area_light < 0) continue;
    const Rgb radiance = area_lights[static_cast<std::size_t>(mesh.area_light)].radiance;
    if (is_black(radiance)) continue;
    mesh_first_[m] = static_cast<std::uint32_t>(triangles_.size());
    for (const auto& [i, j, k] : mesh.triangles) {
      const Point3 a = mesh.positions[i], b = mesh.positions[j], c = mesh.positions[k];
      TriangleShape shape = triangle_shape(a, b, c);
      if (mesh.flip_normals) shape.normal = -shape.normal;
      const double area = triangle_area(a, b, c);
      triangles_.push_back({{a, b, c, shape}, radiance, area});
      weights.push_back(area * std::numbers::pi * luminance(radiance));
      for (int channel = 0; channel < 3; ++channel) power[channel] += area * std::numbers::pi * radiance[channel];
    }
  }
  for (const LightPtr& light : lights) {
    const Rgb light_power = light->power(extent.scene);
    if (is_black(light_power)) continue;
    lights_.push_back(light);
    weights.push_back(luminance(light->power(entry_ball(extent))));
    for (int channel = 0; channel < 3; ++channel) power[channel] += light_power[channel];
  }
  by_power_ = DiscreteDistribution(weights);
  if (by_power_.total() == 0) {
    triangles_.clear(), lights_.clear();
    mesh_first_.assign(meshes.size(), k_no_emitter);
    return;
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    triangles_[i].pdf_area = by_power_.probability(i) / triangles_[i].area;
  power_ = {static_cast<float>(power[0]), static_cast<float>(power[1]), static_cast<float>(power[2])};
  weights.erase(weights.begin(), weights.end() - static_cast<std::ptrdiff_t>(lights_.size()));
  lights_by_power_ = DiscreteDistribution(weights);
  for (std::size_t i = 0; i < lights_.size(); ++i)
    if (lights_[i]->is_environment())
      environments_.push_back({lights_[i], static_cast<float>(by_power_.probability(triangles_.size() + i)),
                               static_cast<float>(lights_by_power_.probability(i))});
}

std::optional<DirectSample> Emitters::sample_direct(const Point3& reference, double u, float v,
                                                    EmitterChoice choice) const {
  const bool among_all = choice == EmitterChoice::all;
  if (among_all ? empty() : lights_.empty()) return std::nullopt;
  const DiscreteDistribution::Sample chosen = (among_all ? by_power_ : lights_by_power_).sample(u);
  const Vec2 u_point{chosen.remapped, v};
  const std::size_t triangles = among_all ? triangles_.size() : 0;
  if (chosen.index < triangles) return sample_triangle(triangles_[chosen.index], reference, u_point);
  auto sample = lights_[chosen.index - triangles]->sample_direct(reference, u_point);
  if (sample) sample->pdf_solid_angle *= static_cast<float>(chosen.probability);
  return sample;
}

std::optional<DirectSample> Emitters::sample_triangle(const EmissiveTriangle& emitter, const Point3& reference,
                                                      Vec2 u) {
  const Vec2 b = square_to_triangle(u);
  const Point3 position = triangle_position(emitter.triangle, b.x, b.y);
  const auto& [n, error, inset_b, inset_c, kept] = emitter.triangle.shape;
  const Vec3 to_emitter = position - reference;
  const float distance = length(to_emitter);
  const float pdf = to_solid_angle(emitter.pdf_area, n, -to_emitter, distance);
  std::optional<DirectSample> sample;
  if (!(pdf > 0)) return sample;
  sample.emplace();
  sample->pdf_solid_angle = pdf;
  sample->wi = to_emitter / distance;
  sample->radiance = emitter.radiance;
  sample->position = offset_position(position, n, error, -to_emitter);
  return sample;
}

float Emitters::pdf_direct(const Point3& reference, const SurfacePoint& hit) const {
  const EmissiveTriangle* emitter = find(hit);
  if (!emitter) return 0;
  const Vec3 to_reference = reference - hit.position;
  return to_solid_angle(emitter->pdf_area, emitter->triangle.shape.normal, to_reference, length(to_reference));
}

Rgb Emitters::radiance(const SurfacePoint& hit, const Vec3& wo) const {
  const EmissiveTriangle* emitter = find(hit);
  return emitter && dot(emitter->triangle.shape.normal, wo) > 0 ? emitter->radiance : Rgb();
}

EmissionSample Emitters::sample_emission(double u_select, Vec2 u_point, Vec2 u_direction) const {
  assert(!empty());
  const DiscreteDistribution::Sample choice = by_power_.sample(u_select);
  EmissionSample sample =
      choice.index < triangles_.size()
          ? sample_triangle_emission(triangles_[choice.index], u_point, u_direction)
          : lights_[choice.index - triangles_.size()]->sample_emission(u_point, u_direction, extent_);
  sample.power *= static_cast<float>(1 / choice.probability);
  return sample;
}

EmissionSample Emitters::sample_triangle_emission(const EmissiveTriangle& emitter, Vec2 u_point, Vec2 u_direction) {
  const Vec2 b = square_to_triangle(u_point);
  const Point3 position = triangle_position(emitter.triangle, b.x, b.y);
  const auto& [n, error, inset_b, inset_c, kept] = emitter.triangle.shape;
  const Vec3 direction = frame_from_normal(n).to_world(square_to_cosine_hemisphere(u_direction));
  // Le cos / (1 / area * cos / pi)
  const auto flux = static_cast<float>(std::numbers::pi * emitter.area);
  return {.ray = {offset_position(position, n, error, direction), direction},
          .power = flux * emitter.radiance,
          .origin = EmittingPoint{position, n, error}};
}

const Emitters::EmissiveTriangle* Emitters::find(const SurfacePoint& hit) const {
  if (hit.mesh >= mesh_first_.size() || mesh_first_[hit.mesh] == k_no_emitter) return nullptr;
  return &triangles_[mesh_first_[hit.mesh] + hit.triangle];
}

}  // namespace gradslc
