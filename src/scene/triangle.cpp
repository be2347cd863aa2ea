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

TrianglePlane triangle_plane(Point3 a, Point3 b, Point3 c) {
  const Double3 n = cross(subtract(b, a), subtract(c, a));
  const double double_area = length(n);
  if (!(double_area > 0)) return {0, {}};
  const auto component = [&](double value) { return static_cast<float>(value / double_area); };
  return {double_area, {component(n.x), component(n.y), component(n.z)}};
}

TrianglePosition triangle_position(Point3 a, Point3 b, Point3 c, Normal3 normal, float b1, float b2) {
  const Double3 ab = subtract(b, a), ac = subtract(c, a);
  const double edges[3] = {length(subtract(c, b)), length(ac), length(ab)};  // opposite to a, b, c
  const double longest = std::max({edges[0], edges[1], edges[2]});
  const double double_area = length(cross(ab, ac));
  const double slenderness = std::max(1.0, edges[0] * edges[1] * edges[2] / (longest * double_area));

  const double w1 = std::clamp(double{b1}, 0.0, 1.0);
  const double w2 = std::clamp(double{b2}, 0.0, 1.0 - w1);
  const auto rounding_at = [&](double v1, double v2) {
    return std::abs(normal.x * (a.x + v1 * ab.x + v2 * ac.x)) + std::abs(normal.y * (a.y + v1 * ab.y + v2 * ac.y)) +
           std::abs(normal.z * (a.z + v1 * ab.z + v2 * ac.z));
  };
  const double error = k_unit_roundoff * (2 * rounding_at(w1, w2) + k_plane_roundings * longest * slenderness);

  // The height over an edge is double_area / edge: what `error` is as a barycentric coordinate.
  const auto inset = [&](double edge) { return std::min(error * edge / double_area, 1.0 / 3); };
  const double inset1 = inset(edges[1]), inset2 = inset(edges[2]);
  const double kept = 1 - inset(edges[0]) - inset1 - inset2;
  const double v1 = inset1 + kept * w1, v2 = inset2 + kept * w2;
  const auto at = [&](float origin, double u, double v) { return static_cast<float>(origin + v1 * u + v2 * v); };
  return {{at(a.x, ab.x, ac.x), at(a.y, ab.y, ac.y), at(a.z, ab.z, ac.z)}, static_cast<float>(error)};
}

}  // namespace gradslc
