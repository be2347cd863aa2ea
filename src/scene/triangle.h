#pragma once

#include "core/vec.h"

namespace gradslc {

/// What depends on a triangle's corners alone, made once per triangle. `normal` and `height_inverse` are meaningless
/// where `double_area` is 0.
struct TriangleShape {
  double double_area = 0;        ///< twice the area
  Normal3 normal;                ///< unit, of the winding a, b, c
  float extent = 0;              ///< L s of triangle_position()
  float height_inverse[3] = {};  ///< 1 / height over the edge opposite to a, b, c: distances to barycentric coordinates
};
TriangleShape triangle_shape(Point3 a, Point3 b, Point3 c);

/// A point of a triangle, rounded to float once.
struct TrianglePosition {
  Point3 position;
  float error;  ///< how far along the normal rays must start to be on the normal's side of the triangle for sure
};

/// The point (1 - b1 - b2) a + b1 b + b2 c of a triangle with positive area; b1, b2 >= 0, b1 + b2 <= 1 up to rounding.
/// `shape` is the triangle's; its normal is n.
///
/// `error` scales with the scene and is the sum of two parts, u = 2^-24 the unit roundoff:
/// - 2 u (|n| . |p|): the position is interpolated in double and rounded to float once per axis, which moves it by at
///   most u |p| per axis (Higham 2002, section 2.2), projected onto the normal; and once more when it is offset.
/// - k u L s: the plane's distance as the ray tracer computes it from single-precision edges, L the longest edge and
///   s >= 1 the amplification of rounding in the cross product of slender triangles (product of the two shorter edges
///   over twice the area). First-order analysis gives k = 6 (difference to the origin 1, cross product 2, dot product
///   3); k = 12 is used.
TrianglePosition triangle_position(Point3 a, Point3 b, Point3 c, const TriangleShape& shape, float b1, float b2);

}  // namespace gradslc
