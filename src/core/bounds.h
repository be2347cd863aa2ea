#pragma once

#include "core/constants.h"
#include "core/vec.h"

namespace gradslc {

/// An axis-aligned box; empty (lower > upper) by default.
struct Bounds3 {
  Point3 lower{k_infinity, k_infinity, k_infinity};
  Point3 upper{-k_infinity, -k_infinity, -k_infinity};

  bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  Point3 centre() const { return lower + 0.5f * (upper - lower); }
  Vec3 diagonal() const { return upper - lower; }
  bool contains(Point3 p) const {
    return p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x <= upper.x && p.y <= upper.y && p.z <= upper.z;
  }
  void extend(Point3 p) { lower = min(lower, p), upper = max(upper, p); }
  void extend(const Bounds3& o) { lower = min(lower, o.lower), upper = max(upper, o.upper); }

  /// Squared distance from `p` to the nearest point of the box; 0 inside.
  float min_distance_squared(Point3 p) const {
    const Vec3 d{std::max({lower.x - p.x, p.x - upper.x, 0.0f}), std::max({lower.y - p.y, p.y - upper.y, 0.0f}),
                 std::max({lower.z - p.z, p.z - upper.z, 0.0f})};
    return length_squared(d);
  }
  /// Squared distance from `p` to the farthest point of the box.
  float max_distance_squared(Point3 p) const {
    const Vec3 d{std::max(p.x - lower.x, upper.x - p.x), std::max(p.y - lower.y, upper.y - p.y),
                 std::max(p.z - lower.z, upper.z - p.z)};
    return length_squared(d);
  }
  /// Largest absolute coordinate of any corner.
  float max_abs_coordinate() const {
    return std::max(max_component(abs(from_origin(lower))), max_component(abs(from_origin(upper))));
  }
};

}  // namespace gradslc
