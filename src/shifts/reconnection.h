#pragma once

#include <cmath>

#include "core/vec.h"
#include "shifts/shift_result.h"

namespace gradslc {

/// Reconnects `offset` to the surface point `target` that the base path reaches from `base`. `normal`: the target's
/// geometric one, on either side. Returns the unit direction in world space; its Jacobian is
/// |cos' / cos| (d / d')^2, cosines at the target (Lehtinen et al. 2013; Kettunen et al. 2015).
inline ShiftResult<ShiftedDirection> reconnect(Point3 base, Point3 offset, Point3 target, Normal3 normal) {
  const Vec3 from_base = target - base, from_offset = target - offset;
  const float distance_cos_base = dot(from_base, normal), distance_cos_offset = dot(from_offset, normal);
  if (distance_cos_base == 0 || distance_cos_offset == 0) return ShiftFailure::degenerate;
  if ((distance_cos_base > 0) != (distance_cos_offset > 0)) return ShiftFailure::back_facing;
  const float distance = length(from_offset), ratio = length(from_base) / distance;
  const float jacobian = distance_cos_offset / distance_cos_base * ratio * ratio * ratio;
  if (!(jacobian > 0) || !std::isfinite(jacobian)) return ShiftFailure::degenerate;
  return ShiftedDirection{from_offset / distance, jacobian};
}

/// The same where the base path leaves the scene: what is at infinity is seen in the same direction.
inline ShiftedDirection reconnect_to_infinity(Vec3 direction) { return {direction, 1}; }

}  // namespace gradslc
