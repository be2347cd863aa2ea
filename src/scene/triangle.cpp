#include "scene/triangle.h"

#include <limits>

namespace gradslc {
namespace {

struct Double3 {
  double x, y, z;
};
Double3 subtract(Point3 a, Point3 b) {
  return {double{a.x} - double{b.x}, double{a.y} - double{b.y}, double{a.z} - double{b.z}};
}
Double3 cross(Double3 a, Double3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Double3 a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

}  // namespace

TriangleShape triangle_shape(Point3 a, Point3 b, Point3 c) {
  const Double3 ab = subtract(b, a), ac = subtract(c, a);
  const Double3 n = cross(ab, ac);
  const double double_area = length(n);
  TriangleShape shape;
  if (!(double_area > 0)) return shape;
  const double per_area = 1 / double_area;
  shape.normal = {static_cast<float>(n.x * per_area), static_cast<float>(n.y * per_area),
                  static_cast<float>(n.z * per_area)};
  const double edges[3] = {length(subtract(c, b)), length(ac), length(ab)};  // opposite to a, b, c
  // longest * slenderness is the product of all edges over twice the area, but at least the longest edge.
  const double longest = std::max({edges[0], edges[1], edges[2]});
  const double extent = std::max(longest, edges[0] * edges[1] * edges[2] * per_area);
  double rounding = 0;
  for (const Point3 corner : {a, b, c})
    rounding = std::max(rounding, double{dot(abs(as_vec(shape.normal)), abs(from_origin(corner)))});
  constexpr double unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
  constexpr double plane_roundings = 12;  // k
  const double error = unit_roundoff * (2 * rounding + plane_roundings * extent);

  const auto inset = [&](int corner) { return std::min(error * edges[corner] * per_area, 1.0 / 3); };
  shape.error = static_cast<float>(error);
  shape.inset_b = static_cast<float>(inset(1)), shape.inset_c = static_cast<float>(inset(2));
  shape.kept = static_cast<float>(std::max(0.0, 1 - inset(0) - inset(1) - inset(2)));
  return shape;
}

double triangle_area(Point3 a, Point3 b, Point3 c) { return length(cross(subtract(b, a), subtract(c, a))) / 2; }

}  // namespace gradslc
