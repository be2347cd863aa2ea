#pragma once

#include <algorithm>
#include <cstdint>

#include "core/frame.h"
#include "core/ray.h"
#include "core/vec.h"
#include "materials/material.h"

namespace gradslc {

constexpr std::uint32_t k_no_emitter = 0xffffffffu;

/// A point on a surface of the scene.
struct SurfacePoint {
  Point3 position;
  Normal3 shading_normal;    ///< unit; the mesh's normals interpolated, or the geometric one; not facing the ray
  Normal3 geometric_normal;  ///< unit; on the side of shading_normal
  Vec2 uv;
  std::uint32_t mesh = 0, triangle = 0;
  std::uint32_t material = 0;
  float error = 0;  ///< bound of the position's rounding error, scene units: how far rays must start from the surface
};

/// A surface point with what scattering there needs. `bsdf` and `wo` are in `frame`.
struct ShadedPoint : Shading {
  SurfacePoint point;
  Vec3 wo;  ///< local, unit: the direction in which the path has come

  Vec3 to_local(Vec3 v) const { return frame.to_local(v); }
  Vec3 to_world(Vec3 v) const { return frame.to_world(v); }
};

/// A position moved off its surface to the side of `direction`, by its error bound: where rays may start and end.
inline Point3 offset_position(Point3 position, Normal3 geometric_normal, float error, Vec3 direction) {
  return position + error * as_vec(face_forward(geometric_normal, direction));
}
inline Point3 offset_position(const SurfacePoint& point, Vec3 direction) {
  return offset_position(point.position, point.geometric_normal, point.error, direction);
}

/// A ray that leaves `point` in the unit direction `direction`.
inline Ray spawn_ray(const SurfacePoint& point, Vec3 direction, float max_distance = k_infinity) {
  return {offset_position(point, direction), direction, max_distance};
}

/// Where a segment ends before its end point, as a part of its length. The end point is offset off its surface already,
/// by an error bound that suits rays from nearby; this covers the rounding of the hit distance seen from afar, measured
/// at up to about 16 ulp / cos, for angles up to 89 degrees. What stands closer to the end point than that does not
/// occlude.
constexpr float k_segment_end = 1 - 1e-4f;

/// What is left of `ray` beyond the point `at` on it, where it passes straight through the surface.
inline Ray pass_on(const Ray& ray, const SurfacePoint& at) {
  const Point3 start = offset_position(at, ray.direction);
  const float passed = dot(start - ray.origin, ray.direction) / length_squared(ray.direction);
  return {start, ray.direction, std::max(0.0f, ray.max_distance - passed)};
}

/// The open segment between two positions that are already offset: direction is `to - from`, not normalised, and
/// max_distance is k_segment_end, so that rounding of the hit distance does not make the end point's own surface
/// occlude it.
inline Ray segment(Point3 from, Point3 to) { return {from, to - from, k_segment_end}; }

}  // namespace gradslc
