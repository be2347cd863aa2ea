#include "scene/triangle.h"

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
  shape.extent = static_cast<float>(std::max(longest, edges[0] * edges[1] * edges[2] * per_area));
  for (int i = 0; i < 3; ++i) shape.height_inverse[i] = static_cast<float>(edges[i] * per_area);
  return shape;
}

double triangle_area(Point3 a, Point3 b, Point3 c) { return length(cross(subtract(b, a), subtract(c, a))) / 2; }

}  // namespace gradslc
