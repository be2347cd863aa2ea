#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vec.h"

namespace gradslc {

/// What depends on a triangle's corners alone, made once per triangle. `normal` and `height_inverse` are meaningless
/// where the triangle has no area.
struct TriangleShape {
  Normal3 normal;                ///< unit, of the winding a, b, c
  float extent = 0;              ///< L s of triangle_position(); 0 where the triangle has no area
  float height_inverse[3] = {};  ///< 1 / height over the edge opposite to a, b, c: distances to barycentric coordinates

  bool has_area() const { return extent > 0; }
};
TriangleShape triangle_shape(Point3 a, Point3 b, Point3 c);
double triangle_area(Point3 a, Point3 b, Point3 c);

struct Triangle {
  Point3 a, b, c;
  TriangleShape shape;
};

/// A point of a triangle, rounded to float once.
struct TrianglePosition {
  Point3 position;
  float error;  ///< how far along the normal rays must start to be on the normal's side of the triangle for sure
};

/// The point (1 - b1 - b2) a + b1 b + b2 c of a triangle with area; b1, b2 >= 0, b1 + b2 <= 1 up to rounding. It is
/// moved into the triangle by `error`, where there is room. n is the triangle's normal.
///
/// `error` scales with the scene and is the sum of two parts, u = 2^-24 the unit roundoff:
/// - 2 u (|n| . |p|): the position is interpolated in double and rounded to float once per axis, which moves it by at
///   most u |p| per axis (Higham 2002, section 2.2), projected onto the normal; and once more when it is offset.
/// - k u L s: the plane's distance as the ray tracer computes it from single-precision edges, L the longest edge and
///   s >= 1 the amplification of rounding in the cross product of slender triangles (product of the two shorter edges
///   over twice the area). First-order analysis gives k = 6 (difference to the origin 1, cross product 2, dot product
///   3); k = 12 is used, which also covers that the error itself is computed in float.
inline TrianglePosition triangle_position(const Triangle& triangle, float b1, float b2) {
  constexpr float unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
  constexpr float plane_roundings = 12;  // k
  const auto& [a, b, c, shape] = triangle;
  const float w1 = std::clamp(b1, 0.0f, 1.0f);
  const float w2 = std::clamp(b2, 0.0f, 1 - w1);
  const Vec3 p = from_origin(a) + w1 * (b - a) + w2 * (c - a);
  const float rounding = dot(abs(as_vec(shape.normal)), abs(p));
  const float error = unit_roundoff * (2 * rounding + plane_roundings * shape.extent);

  const auto inset = [&](int corner) { return std::min(error * triangle.shape.height_inverse[corner], 1.0f / 3); };
  const float inset1 = inset(1), inset2 = inset(2);
  const float kept = 1 - inset(0) - inset1 - inset2;
  const double v1 = inset1 + kept * w1, v2 = inset2 + kept * w2;
  const auto at = [&](double origin, float to_b, float to_c) {
    return static_cast<float>(origin + v1 * (to_b - origin) + v2 * (to_c - origin));
  };
  return {{at(a.x, b.x, c.x), at(a.y, b.y, c.y), at(a.z, b.z, c.z)}, error};
}

}  // namespace gradslc
