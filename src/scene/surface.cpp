#include "scene/surface.h"

#include <algorithm>

namespace gradslc {
namespace {

/// Where a segment ends before its end point, as a part of its length. The end point is offset off its surface already,
/// by an error bound that suits rays from nearby; this covers the rounding of the hit distance seen from afar, measured
/// at up to about 16 ulp / cos, for angles up to 89 degrees. What stands closer to the end point than that does not
/// occlude.
constexpr float k_segment_end = 1 - 1e-4f;

}  // namespace

Point3 offset_position(Point3 position, Normal3 geometric_normal, float error, Vec3 direction) {
  return position + error * as_vec(face_forward(geometric_normal, direction));
}

Point3 offset_position(const SurfacePoint& point, Vec3 direction) {
  return offset_position(point.position, point.geometric_normal, point.error, direction);
}

Ray spawn_ray(const SurfacePoint& point, Vec3 direction, float max_distance) {
  return {offset_position(point, direction), direction, max_distance};
}

Ray pass_on(const Ray& ray, const SurfacePoint& at) {
  const Point3 start = offset_position(at, ray.direction);
  const float passed = dot(start - ray.origin, ray.direction) / length_squared(ray.direction);
  return {start, ray.direction, std::max(0.0f, ray.max_distance - passed)};
}

Ray segment(Point3 from, Point3 to) { return {from, to - from, k_segment_end}; }

}  // namespace gradslc
