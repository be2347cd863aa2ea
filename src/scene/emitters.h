#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/distribution.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/surface.h"
#include "scene/triangle.h"

namespace gradslc {

/// Diffuse emission of a mesh: constant radiance on the side of the geometric normal.
struct AreaLight {
  Rgb radiance;
};

using LightPtr = std::shared_ptr<const Light>;

/// Among which emitters next-event estimation chooses.
enum class EmitterChoice : std::uint8_t { all, without_area_lights };

/// All emitters of a scene, chosen in proportion to power (luminance): every triangle of an area light is one, and so
/// is every other light. The power of light from infinity counts as far as it comes to where the camera looks.
class Emitters {
 public:
  Emitters() = default;
  Emitters(const std::vector<TriangleMesh>& meshes, const std::vector<AreaLight>& area_lights,
           const std::vector<LightPtr>& lights, const EmissionExtent& extent);

  bool empty() const { return triangles_.empty() && lights_.empty(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  /// Total emitted power (flux) per channel.
  Rgb power() const { return power_; }

  /// `u` chooses the emitter; what is left of it, stretched, and `v` choose the point or direction. Both in [0,1).
  /// nullopt where the choice does not light the reference, or there is none.
  std::optional<DirectSample> sample_direct(const Point3& reference, double u, float v,
                                            EmitterChoice choice = EmitterChoice::all) const;
  /// Density of sample_direct among all at a hit: the emitter's triangle was reached from `reference` at `hit`; 1/sr.
  float pdf_direct(const Point3& reference, const SurfacePoint& hit) const;
  /// Radiance that leaves `hit` towards the unit direction `wo`; 0 where it emits nothing.
  Rgb radiance(const SurfacePoint& hit, const Vec3& wo) const;
  /// Only with !empty().
  EmissionSample sample_emission(double u_select, Vec2 u_point, Vec2 u_direction) const;

  /// A light that rays out of the scene meet, and the probabilities of its choice by sample_direct().
  struct Environment {
    LightPtr light;
    float probability, probability_without_area_lights;
  };
  std::span<const Environment> environments() const { return environments_; }

 private:
  struct EmissiveTriangle {
    Triangle triangle;  // its normal on the emitting side
    Rgb radiance;
    double area;
    double pdf_area = 0;  // of sample_direct(), the triangle's choice included
  };
  const EmissiveTriangle* find(const SurfacePoint& hit) const;  // null: it does not emit
  static std::optional<DirectSample> sample_triangle(const EmissiveTriangle& emitter, const Point3& reference, Vec2 u);
  static EmissionSample sample_triangle_emission(const EmissiveTriangle& emitter, Vec2 u_point, Vec2 u_direction);

  std::vector<EmissiveTriangle> triangles_;  // all triangles of the meshes that emit, mesh by mesh
  std::vector<std::uint32_t> mesh_first_;    // per mesh: index of its first emissive triangle, or k_no_emitter
  std::vector<LightPtr> lights_;             // those with power
  std::vector<Environment> environments_;
  EmissionExtent extent_;
  DiscreteDistribution by_power_;         // triangles, then lights
  DiscreteDistribution lights_by_power_;  // lights alone
  Rgb power_;
};

}  // namespace gradslc
