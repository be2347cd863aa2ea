#include "scene/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gradslc {
namespace {

constexpr double k_unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
constexpr double k_plane_roundings = 12;  // k of triangle_position()

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
  TriangleShape shape;
  shape.double_area = length(n);
  if (!(shape.double_area > 0)) return shape;
  const double per_area = 1 / shape.double_area;
  shape.normal = {static_cast<float>(n.x * per_area), static_cast<float>(n.y * per_area),
                  static_cast<float>(n.z * per_area)};
  const double edges[3] = {length(subtract(c, b)), length(ac), length(ab)};  // opposite to a, b, c
  // longest * slenderness is the product of all edges over twice the area, but at least the longest edge.
  const double longest = std::max({edges[0], edges[1], edges[2]});
  shape.extent = static_cast<float>(std::max(longest, edges[0] * edges[1] * edges[2] * per_area));
  for (int i = 0; i < 3; ++i) shape.height_inverse[i] = static_cast<float>(edges[i] * per_area);
  return shape;
}

TrianglePosition triangle_position(Point3 a, Point3 b, Point3 c, const TriangleShape& shape, float b1, float b2) {
  const Double3 ab = subtract(b, a), ac = subtract(c, a);
  const double w1 = std::clamp(double{b1}, 0.0, 1.0);
  const double w2 = std::clamp(double{b2}, 0.0, 1.0 - w1);
  const Normal3 n = shape.normal;
  const double rounding = std::abs(n.x * (a.x + w1 * ab.x + w2 * ac.x)) +
                          std::abs(n.y * (a.y + w1 * ab.y + w2 * ac.y)) + std::abs(n.z * (a.z + w1 * ab.z + w2 * ac.z));
  const double error = k_unit_roundoff * (2 * rounding + k_plane_roundings * static_cast<double>(shape.extent));

  const auto inset = [&](int corner) {
    return std::min(error * static_cast<double>(shape.height_inverse[corner]), 1.0 / 3);
  };
  const double inset1 = inset(1), inset2 = inset(2);
  const double kept = 1 - inset(0) - inset1 - inset2;
  const double v1 = inset1 + kept * w1, v2 = inset2 + kept * w2;
  const auto at = [&](float origin, double u, double v) { return static_cast<float>(origin + v1 * u + v2 * v); };
  return {{at(a.x, ab.x, ac.x), at(a.y, ab.y, ac.y), at(a.z, ab.z, ac.z)}, static_cast<float>(error)};
}

}  // namespace gradslc
