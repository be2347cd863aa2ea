#pragma once
// Light from infinity enters the scene through a disk of the bounding ball's radius, perpendicular to its direction.

#include "core/constants.h"
#include "core/frame.h"
#include "core/warp.h"
#include "scene/light.h"

namespace gradslc {

inline float disk_area(const BoundingSphere& scene) { return k_pi * scene.radius * scene.radius; }

/// A particle that comes from the unit direction `towards_light`; `irradiance` is that of the disk (for a radiance,
/// over the direction's pdf_solid_angle). It starts two radii from the centre, clear of every surface in spite of
/// rounding.
inline EmissionSample emit_through_disk(Vec3 towards_light, Rgb irradiance, Vec2 u_point, const BoundingSphere& scene) {
  const Vec2 disk = square_to_disk(u_point);
  const Frame frame = frame_from_normal(as_normal(towards_light));
  const Point3 origin = scene.centre + scene.radius * frame.to_world({disk.x, disk.y, 2});
  return {Ray{origin, -towards_light}, disk_area(scene) * irradiance};
}

}  // namespace gradslc
