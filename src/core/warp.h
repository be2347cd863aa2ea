#pragma once
// Maps from the unit square to the domains that are sampled, each with its density.

#include "core/constants.h"
#include "core/vec.h"

namespace gradslc {

/// Cosine and sine of t pi/4 for t in [-1,1], to 2e-7: polynomials that interpolate at Chebyshev's nodes.
constexpr Vec2 cos_sin_of_octant(float t) {
  const float t2 = t * t;
  return {1 + t2 * (-0.308425039f + t2 * (0.0158523452f + t2 * -0.000320646941f)),
          t * (0.785398185f + t2 * (-0.0807454363f + t2 * (0.00249000685f + t2 * -3.59542901e-05f)))};
}

/// Uniform on the unit disk, area measure 1/pi (Shirley and Chiu 1997: concentric, keeps strata compact).
inline Vec2 square_to_disk(Vec2 u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  const bool horizontal = std::abs(a) > std::abs(b);
  const float radius = horizontal ? a : b;
  if (radius == 0) return {0, 0};
  const Vec2 p = radius * cos_sin_of_octant((horizontal ? b : a) / radius);
  return {horizontal ? p.x : p.y, horizontal ? p.y : p.x};
}

/// Direction of the upper hemisphere with pdf_solid_angle = cos / pi (Malley's method).
inline Vec3 square_to_cosine_hemisphere(Vec2 u) {
  const Vec2 d = square_to_disk(u);
  return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}
inline float cosine_hemisphere_pdf_solid_angle(float cos_theta) { return std::max(cos_theta, 0.0f) * k_inv_pi; }

/// Direction of the sphere with pdf_solid_angle = 1 / 4pi.
inline Vec3 square_to_sphere(Vec2 u) {
  const float z = 1 - 2 * u.x;
  const float radius = std::sqrt(std::max(0.0f, 1 - z * z));
  return {radius * std::cos(2 * k_pi * u.y), radius * std::sin(2 * k_pi * u.y), z};
}

/// Barycentric coordinates (b1, b2) of a point uniform on a triangle (Heitz 2019, "A Low-Distortion Map").
inline Vec2 square_to_triangle(Vec2 u) {
  const float half = std::min(u.x, u.y) / 2;
  return {u.x - half, u.y - half};
}

}  // namespace gradslc
