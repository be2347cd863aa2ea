#include "scene/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gradslc {
namespace {

constexpr double k_unit_roundoff = std::numeric_limits<float>::epsilon() / 2;
constexpr double k_plane_roundings = 12;

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
  const double w1 = std::clamp(double{b1}, 0.0, 1.0);
  const double w2 = std::clamp(double{b2}, 0.0, 1.0 - w1);
  const Double3 ab = subtract(b, a), ac = subtract(c, a);
  const auto at = [&](float origin, double u, double v) { return static_cast<float>(origin + w1 * u + w2 * v); };
  const Point3 p{at(a.x, ab.x, ac.x), at(a.y, ab.y, ac.y), at(a.z, ab.z, ac.z)};

  const double rounding =
      std::abs(double{normal.x} * p.x) + std::abs(double{normal.y} * p.y) + std::abs(double{normal.z} * p.z);
  double edges[3] = {length(ab), length(ac), length(subtract(c, b))};
  std::sort(edges, edges + 3);
  const double slenderness = std::max(1.0, edges[0] * edges[1] / length(cross(ab, ac)));
  const double error = k_unit_roundoff * (2 * rounding + k_plane_roundings * edges[2] * slenderness);
  return {p, static_cast<float>(error)};
}

}  // namespace gradslc
