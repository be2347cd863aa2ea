#pragma once
// Light from infinity enters the scene through disks of the radii of balls, perpendicular to its direction.

#include <cmath>

#include "core/constants.h"
#include "core/frame.h"
#include "core/warp.h"
#include "scene/light.h"

namespace gradslc {

inline float disk_area(const BoundingSphere& scene) { return k_pi * scene.radius * scene.radius; }

/// Density at which particles cross the plane through the focus perpendicular to their direction, 1/m^2.
inline float density_on_disks(const EmissionExtent& extent, bool in_focus) {
  const float everywhere = 1 / disk_area(extent.scene);
  if (!(extent.focus.radius > 0)) return everywhere;
  return (1 - EmissionExtent::k_focus_share) * everywhere +
         (in_focus ? EmissionExtent::k_focus_share / disk_area(extent.focus) : 0);
}

/// A ball whose disk has the density of the focus everywhere.
inline BoundingSphere entry_ball(const EmissionExtent& extent) {
  return {extent.focus.centre, std::sqrt(1 / (k_pi * density_on_disks(extent, true)))};
}

/// A particle that comes from the unit direction `towards_light`; `irradiance` is that of the disk (for a radiance,
/// over the direction's pdf_solid_angle). It starts two of the scene's radii from a disk's centre, clear of every
/// surface in spite of rounding.
inline EmissionSample emit_through_disk(Vec3 towards_light, Rgb irradiance, Vec2 u_point,
                                        const EmissionExtent& extent) {
  constexpr float k_share = EmissionExtent::k_focus_share;
  const bool has_focus = extent.focus.radius > 0, focused = has_focus && u_point.x < k_share;
  if (has_focus) u_point.x = focused ? u_point.x / k_share : (u_point.x - k_share) / (1 - k_share);
  const BoundingSphere& ball = focused ? extent.focus : extent.scene;
  const Vec2 disk = square_to_disk(u_point);
  const Frame frame = frame_from_normal(as_normal(towards_light));
  const Point3 place = ball.centre + ball.radius * frame.to_world({disk.x, disk.y, 0});
  const Vec3 from_focus = frame.to_local(place - extent.focus.centre);
  const float focus2 = extent.focus.radius * extent.focus.radius;
  const bool in_focus = focused || from_focus.x * from_focus.x + from_focus.y * from_focus.y < focus2;
  return {Ray{place + (2 * extent.scene.radius) * towards_light, -towards_light},
          irradiance / density_on_disks(extent, in_focus)};
}

}  // namespace gradslc
