#pragma once

#include <cmath>

#include "core/vec.h"
#include "shifts/shift_result.h"

namespace gradslc {

// Half-vector copy (Kettunen et al. 2015, after Jakob and Marschner 2012): the offset is scattered by a
// facet that has the same normal h in its local frame as the base's. Directions are unit and local, +z the normal; wo
// are given, wi sampled. Since dh' = dh, the Jacobian is |dh/dwi| at the base over |dh'/dwi'| at the offset.

/// Reflection: |dh/dwi| = 1 / (4 |wo.h|), so that the Jacobian is |wo'.h| / |wo.h|.
inline ShiftResult<ShiftedDirection> copy_half_vector_of_reflection(const Vec3& wo_base, const Vec3& wi_base,
                                                                    const Vec3& wo_offset) {
  const Vec3 sum = wo_base + wi_base;
  const float twice_cos = length(sum);  // 2 wo.h
  if (!(twice_cos > 0)) return ShiftFailure::degenerate;
  if (wo_base.z * wo_offset.z <= 0) return ShiftFailure::back_facing;
  const Vec3 h = sum / twice_cos;
  const float cos_offset = dot(wo_offset, h);
  const Vec3 wi = 2 * cos_offset * h - wo_offset;
  if (wi.z * wo_offset.z <= 0) return ShiftFailure::back_facing;
  const float jacobian = 2 * std::abs(cos_offset) / twice_cos;
  if (!(jacobian > 0)) return ShiftFailure::degenerate;
  return ShiftedDirection{normalize(wi), jacobian};
}

/// Refraction, `eta` the index below each surface over that above: |dh/dwi| = eta_i^2 |wi.h| / (eta_o wo.h + eta_i
/// wi.h)^2 (Walter et al. 2007, eq. 17).
inline ShiftResult<ShiftedDirection> copy_half_vector_of_refraction(const Vec3& wo_base, const Vec3& wi_base,
                                                                    float eta_base, const Vec3& wo_offset,
                                                                    float eta_offset) {
  if (wo_base.z * wo_offset.z <= 0) return ShiftFailure::back_facing;
  const bool outside = wo_base.z > 0;
  const Vec3 sum = (outside ? 1 : eta_base) * wo_base + (outside ? eta_base : 1) * wi_base;
  const float sum_squared = length_squared(sum);
  if (!(sum_squared > 0)) return ShiftFailure::degenerate;
  const Vec3 h = sum / std::sqrt(sum_squared);
  const float cos_i_base = dot(wi_base, h);
  if (dot(wo_base, h) * cos_i_base >= 0) return ShiftFailure::degenerate;  // no facet refracts so

  const float eta_o = outside ? 1 : eta_offset, eta_i = outside ? eta_offset : 1, ratio = eta_o / eta_i;
  const float cos_o = dot(wo_offset, h);
  const float cos2_i = 1 - ratio * ratio * (1 - cos_o * cos_o);
  if (cos2_i <= 0) return ShiftFailure::total_internal_reflection;
  const float cos_i = -std::copysign(std::sqrt(cos2_i), cos_o);
  const Vec3 wi = (ratio * cos_o + cos_i) * h - ratio * wo_offset;
  if (wi.z * wo_offset.z >= 0) return ShiftFailure::back_facing;

  const float eta_i_base = outside ? eta_base : 1;
  const float dh_base = eta_i_base * eta_i_base * std::abs(cos_i_base) / sum_squared;
  const float sum_offset = eta_o * cos_o + eta_i * cos_i;
  const float dh_offset = eta_i * eta_i * std::abs(cos_i) / (sum_offset * sum_offset);
  const float jacobian = dh_base / dh_offset;
  if (!(jacobian > 0) || !std::isfinite(jacobian)) return ShiftFailure::degenerate;
  return ShiftedDirection{normalize(wi), jacobian};
}

}  // namespace gradslc
