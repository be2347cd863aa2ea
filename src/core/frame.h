#pragma once

#include "core/vec.h"

namespace gradslc {

/// A right-handed orthonormal frame; in local coordinates the normal is +z.
struct Frame {
  Vec3 s{1, 0, 0}, t{0, 1, 0};
  Normal3 n{0, 0, 1};

  Vec3 to_local(Vec3 v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 to_world(Vec3 v) const { return v.x * s + v.y * t + v.z * as_vec(n); }
};

/// A frame around a unit normal, without branches (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
inline Frame frame_from_normal(Normal3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1 / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// A frame around a unit normal whose s lies in the plane of the normal and `tangent` (dp/du); any s where that fails.
inline Frame frame_from_normal_and_tangent(Normal3 n, Vec3 tangent) {
  const Vec3 projected = tangent - dot(tangent, n) * as_vec(n);
  const float squared = length_squared(projected);
  if (!(squared > 0)) return frame_from_normal(n);
  const Vec3 s = projected / std::sqrt(squared);
  return {s, cross(as_vec(n), s), n};
}

}  // namespace gradslc
