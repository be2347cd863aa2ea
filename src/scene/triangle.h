#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace gradslc {

/// What depends on a triangle's corners alone, made once per triangle. Meaningless but for has_area() where it
/// has none.
struct TriangleShape {
  Normal3 normal;   ///< unit, of the winding a, b, c
  float error = 0;  ///< how far along the normal rays must start to be on the normal's side of the triangle for sure
  /// How far points are moved into the triangle, in barycentric coordinates, each at most 1/3: of b, of c, and what is
  /// left of 1 when that of a is taken off as well (< 0: no area).
  float inset_b = 0, inset_c = 0, kept = -1;

  bool has_area() const { return kept >= 0; }
};
/// `error` scales with the scene and is the sum of two parts, u = 2^-24 the unit roundoff:
/// - 2 u (|n| . |p|), the largest over the corners and so over the triangle: the position is interpolated in double and
///   rounded to float once per axis, which moves it by at most u |p| per axis (Higham 2002, section 2.2), projected
///   onto the normal; and once more when it is offset.
/// - k u L s: the plane's distance as the ray tracer computes it from single-precision edges, L the longest edge and
///   s >= 1 the amplification of rounding in the cross product of slender triangles (product of the two shorter edges
///   over twice the area). First-order analysis gives k = 6 (difference to the origin 1, cross product 2, dot product
///   3); k = 12 is used.
TriangleShape triangle_shape(Point3 a, Point3 b, Point3 c);
double triangle_area(Point3 a, Point3 b, Point3 c);

struct Triangle {
  Point3 a, b, c;
  TriangleShape shape;
};

/// The point (1 - b1 - b2) a + b1 b + b2 c of a triangle with area, rounded to float once; b1, b2 >= 0, b1 + b2 <= 1 up
/// to rounding. It is moved into the triangle by the shape's `error`, where there is room.
inline Point3 triangle_position(const Triangle& triangle, float b1, float b2) {
  const auto& [a, b, c, shape] = triangle;
  const float w1 = std::clamp(b1, 0.0f, 1.0f);
  const float w2 = std::clamp(b2, 0.0f, 1 - w1);
  const double v1 = shape.inset_b + shape.kept * w1, v2 = shape.inset_c + shape.kept * w2;
  const auto at = [&](double origin, double to_b, double to_c) {
    return static_cast<float>(origin + v1 * (to_b - origin) + v2 * (to_c - origin));
  };
  return {at(a.x, b.x, c.x), at(a.y, b.y, c.y), at(a.z, b.z, c.z)};
}

}  // namespace gradslc
