#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/distribution.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "scene/mesh.h"
#include "scene/surface.h"
#include "scene/triangle.h"

namespace gradslc {

/// Diffuse emission of a mesh: constant radiance on the side of the geometric normal.
struct AreaLight {
  Rgb radiance;
};

/// A point on an emitter, chosen for connection to a reference point.
struct DirectSample {
  Point3 position;        ///< already offset off the emitter towards the reference
  Vec3 wi;                ///< unit, from the reference towards the emitter
  Rgb radiance;           ///< emitted towards the reference, > 0
  float pdf_solid_angle;  ///< at the reference, selection included, > 0
};

/// A photon's start.
struct EmissionSample {
  SurfacePoint point;  ///< k = 0 vertex
  Vec3 direction;      ///< unit
  Rgb power;           ///< Le cos / (pdf_area pdf_solid_angle): what the particle carries if one path is traced.
                       ///< For diffuse emission also the flux of a k = 0 VPL, whose f is then 1/pi
};

/// All emitters of a scene, chosen in proportion to power (luminance); triangles of area lights in this version.
class Emitters {
 public:
  Emitters() = default;
  Emitters(const std::vector<TriangleMesh>& meshes, const std::vector<AreaLight>& lights);

  bool empty() const { return triangles_.empty(); }
  std::size_t size() const { return triangles_.size(); }
  /// Total emitted power (flux) per channel.
  Rgb power() const { return power_; }

  /// `u_select` chooses the emitter, `u` the point. nullopt where the chosen point does not light the reference.
  std::optional<DirectSample> sample_direct(Point3 reference, double u_select, Vec2 u) const;
  /// Density of sample_direct at a hit: the emitter's triangle was reached from `reference` at `hit`; 1/sr.
  float pdf_direct(Point3 reference, const SurfacePoint& hit) const;
  /// Radiance that leaves `hit` towards the unit direction `wo`; 0 where it emits nothing.
  Rgb radiance(const SurfacePoint& hit, Vec3 wo) const;
  /// Only with !empty().
  EmissionSample sample_emission(double u_select, Vec2 u_point, Vec2 u_direction) const;

 private:
  struct EmissiveTriangle {
    Point3 a, b, c;
    TriangleShape shape;  // its normal on the emitting side
    Rgb radiance;
    std::uint32_t mesh, triangle, material;
    double area() const { return shape.double_area / 2; }
  };
  static constexpr std::size_t k_none = static_cast<std::size_t>(-1);
  std::size_t find(const SurfacePoint& hit) const;  // index into triangles_ or k_none
  float pdf_solid_angle(std::size_t index, Point3 reference, Point3 position) const;

  std::vector<EmissiveTriangle> triangles_;  // all triangles of the meshes that emit, mesh by mesh
  std::vector<std::uint32_t> mesh_first_;    // per mesh: index of its first emissive triangle, or k_no_emitter
  DiscreteDistribution by_power_;
  Rgb power_;
};

}  // namespace gradslc
