#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bounds.h"
#include "core/ray.h"
#include "materials/material.h"
#include "scene/camera.h"
#include "scene/emitters.h"
#include "scene/mesh.h"
#include "scene/surface.h"
#include "scene/triangle.h"

namespace gradslc {

/// What a loader makes of a scene file.
struct SceneDescription {
  std::vector<TriangleMesh> meshes;
  std::vector<MaterialPtr> materials;
  std::vector<MaterialName> material_names;  ///< of each material; may be left empty
  std::vector<AreaLight> area_lights;
  std::vector<LightPtr> lights;  ///< all others
  PerspectiveCamera camera;
  std::vector<std::string> notes;            ///< what the file asks for that has no effect here, once each
  std::vector<std::filesystem::path> files;  ///< all that the scene was read from, the scene file first
};

/// What a ray meets of surfaces that let light pass straight through (crossings, DESIGN 2).
struct Passage {
  Rgb transmittance{1};  ///< product over the crossings; black where the ray is blocked
  float probability =
      1;              ///< with which a path sampled in the ray's direction gets through: see Bsdf::pass_probability()
  int crossings = 0;  ///< up to where the ray is found to be blocked
  int rays = 1;       ///< traced to find out
};

/// Geometry, materials, emitters and camera, ready to trace. Immutable; all queries may run concurrently.
class Scene {
 public:
  /// Builds the acceleration structure. Throws Error where a mesh is inconsistent.
  explicit Scene(SceneDescription description);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The nearest hit, whatever side of the surface.
  std::optional<SurfacePoint> intersect(const Ray& ray) const;
  /// What scattering at a point needs; `wo`: unit, world space, towards where the path has come from.
  ShadedPoint shade(const SurfacePoint& point, const Vec3& wo) const {
    ShadedPoint shaded;
    shade(point, wo, shaded);
    return shaded;
  }
  /// The same in place; `shaded` is as it was made.
  void shade(const SurfacePoint& point, const Vec3& wo, ShadedPoint& shaded) const;
  /// Whether anything lies on the ray before its max_distance.
  bool occluded(const Ray& ray) const;
  /// What gets along the ray up to its max_distance. Blocked by a surface that lets nothing pass straight through, and
  /// by any surface after `max_crossings` crossings. As cheap as occluded() where no surface on the ray lets light
  /// pass.
  Passage passage(const Ray& ray, int max_crossings) const;
  /// passage() of many rays, traced together: faster where they are alike. `max_crossings` and `passages`: one for each
  /// ray.
  void passages(std::span<const Ray> rays, std::span<const int> max_crossings, std::span<Passage> passages) const;
  /// Whether any surface lets light pass straight through.
  bool has_crossings() const { return has_crossings_; }

  const PerspectiveCamera& camera() const { return description_.camera; }
  const Emitters& emitters() const { return emitters_; }
  const std::vector<TriangleMesh>& meshes() const { return description_.meshes; }
  const std::vector<MaterialPtr>& materials() const { return description_.materials; }
  const std::vector<MaterialName>& material_names() const { return description_.material_names; }
  const std::vector<LightPtr>& lights() const { return description_.lights; }
  const std::vector<std::string>& notes() const { return description_.notes; }
  const std::vector<std::filesystem::path>& files() const { return description_.files; }
  Bounds3 bounds() const { return bounds_; }
  BoundingSphere bounding_sphere() const;
  std::size_t triangle_count() const;
  /// Bytes of meshes and acceleration structure.
  std::size_t memory_bytes() const;

 private:
  struct Embree;
  /// passage() of a ray that nothing blocks but what may let light pass.
  Passage walk(const Ray& ray, int max_crossings) const;

  SceneDescription description_;
  std::vector<PreparedMesh> prepared_;   // per mesh
  std::vector<bool> needs_derivatives_;  // per material
  std::vector<bool> crosses_;            // per material
  bool has_crossings_ = false;
  Emitters emitters_;
  Bounds3 bounds_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace gradslc
