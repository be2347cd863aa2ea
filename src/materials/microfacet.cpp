#include "materials/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/constants.h"
#include "core/warp.h"

namespace gradslc {
namespace {

constexpr float k_inv_sqrt_pi = std::numbers::inv_sqrtpi_v<float>;

/// To 0.2 % (Winitzki 2008, "A handy approximation for the error function and its inverse"). `y` in (-1, 1).
double approximate_inverse_erf(double y) {
  constexpr double a = 0.147;
  const double log = std::log1p(-y * y), b = 2 / (std::numbers::pi * a) + log / 2;
  return std::copysign(std::sqrt(std::sqrt(b * b - log / a) - b), y);
}

/// Slope x that solves c (1 + erf(x)) + s exp(-x^2)/sqrt(pi) = u times its value at the largest visible slope c/s: the
/// visible slopes of a Beckmann surface of roughness 1 seen under cos = c, sin = s (Heitz and d'Eon 2014). For c = 1,
/// s = 0: a normal variable of variance 1/2. Newton's steps, bisection where they leave the bracket, to 1e-6.
double visible_beckmann_slope(double c, double s, double u) {
  constexpr double limit = 6;  // beyond it the distribution function changes by less than 1e-15
  double low = -limit, high = c < limit * s ? c / s : limit;
  const auto distribution = [c, s](double x) {
    return c * std::erfc(-x) + s * std::numbers::inv_sqrtpi * std::exp(-x * x);
  };
  const double target = u * distribution(high);
  double x = std::min(approximate_inverse_erf(2 * u - 1), high);
  for (int i = 0; i < 60; ++i) {
    const double error = distribution(x) - target;
    (error > 0 ? high : low) = x;
    const double slope = 2 * std::numbers::inv_sqrtpi * std::exp(-x * x) * (c - s * x);
    double next = slope > 0 ? x - error / slope : low;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - x) < 1e-6) return next;
    x = next;
  }
  return x;
}

/// The normal of a surface of roughness 1 that is seen from v (Heitz 2018, "Sampling the GGX Distribution of Visible
/// Normals").
Vec3 visible_ggx_normal(const Vec3& v, Vec2 u) {
  const float squared = v.x * v.x + v.y * v.y;
  const Vec3 t1 = squared > 0 ? Vec3{-v.y, v.x, 0} / std::sqrt(squared) : Vec3{1, 0, 0};
  const Vec3 t2 = cross(v, t1);
  const Vec2 p = square_to_disk(u);
  const float s = 0.5f * (1 + v.z);
  const float y = (1 - s) * std::sqrt(std::max(0.0f, 1 - p.x * p.x)) + s * p.y;
  return p.x * t1 + y * t2 + std::sqrt(std::max(0.0f, 1 - p.x * p.x - y * y)) * v;
}

Vec3 visible_beckmann_normal(const Vec3& v, Vec2 u) {
  constexpr float half_step = 0x1p-25f;  // u = 0 would be an infinite slope
  const float sin_theta = std::sqrt(v.x * v.x + v.y * v.y);
  const auto x = static_cast<float>(visible_beckmann_slope(v.z, sin_theta, std::max(u.x, half_step)));
  const auto y = static_cast<float>(visible_beckmann_slope(1, 0, std::max(u.y, half_step)));
  const float cos_phi = sin_theta > 0 ? v.x / sin_theta : 1, sin_phi = sin_theta > 0 ? v.y / sin_theta : 0;
  return {-(cos_phi * x - sin_phi * y), -(sin_phi * x + cos_phi * y), 1};
}

}  // namespace

Microfacet Microfacet::make(MicrofacetType type, float alpha_u, float alpha_v) {
  return {type, std::max(alpha_u, k_min_alpha), std::max(alpha_v, k_min_alpha)};
}

float Microfacet::d(const Vec3& m) const {
  if (m.z <= 0) return 0;
  const float x = m.x / alpha_u, y = m.y / alpha_v, z2 = m.z * m.z;
  const float area = k_pi * alpha_u * alpha_v;
  if (type == MicrofacetType::ggx) {
    const float root = x * x + y * y + z2;
    return 1 / (area * root * root);
  }
  const float exponent = (x * x + y * y) / z2;
  if (exponent > 80) return 0;  // less than 1e-34
  return std::exp(-exponent) / (area * z2 * z2);
}

float Microfacet::g1_over_cos(const Vec3& v) const {
  const float x = alpha_u * v.x, y = alpha_v * v.y, c = std::abs(v.z);
  const float squared = x * x + y * y;
  if (type == MicrofacetType::ggx) return 2 / (c + std::sqrt(c * c + squared));
  if (c * c > 16 * squared) return 1 / c;  // nothing is masked, to 1e-8
  const float s = std::sqrt(squared), a = c / s;
  return 2 / (c * (1 + std::erf(a)) + s * k_inv_sqrt_pi * std::exp(-a * a));
}

Vec3 Microfacet::sample_visible(const Vec3& v, Vec2 u) const {
  const Vec3 stretched = normalize(Vec3{alpha_u * v.x, alpha_v * v.y, v.z});
  const Vec3 m = type == MicrofacetType::ggx ? visible_ggx_normal(stretched, u) : visible_beckmann_normal(stretched, u);
  return normalize(Vec3{alpha_u * m.x, alpha_v * m.y, std::max(m.z, 0.0f)});
}

float Microfacet::visible_pdf_solid_angle(const Vec3& v, const Vec3& m) const {
  return g1_over_cos(v) * std::max(dot(v, m), 0.0f) * d(m);
}

float Microfacet::max_d(float theta) const {
  const float wide = std::max(alpha_u, alpha_v), wide2 = wide * wide;
  const float area = k_pi * alpha_u * alpha_v;
  const float sin_theta = std::sin(theta), sin2 = sin_theta * sin_theta, cos2 = 1 - sin2;
  if (type == MicrofacetType::ggx) {
    if (wide > 1) return wide2 * wide2 / area;
    const float root = sin2 / wide2 + cos2;
    return 1 / (area * root * root);
  }
  // exp(-t/wide^2) (1 + t)^2 with t = tan^2 falls where 1 + t >= 2 wide^2, its largest value is there.
  if (cos2 * 2 * wide2 >= 1) return 4 * wide2 * wide2 * std::exp(1 / wide2 - 2) / area;
  const float exponent = sin2 / (wide2 * cos2);
  return exponent > 80 ? 0 : std::exp(-exponent) / (area * cos2 * cos2);
}

// Beckmann's exp(-t/alpha^2) (1 + t)^2, t = tan^2, is at most (1 + t)^2 / (1 + t/(2 alpha^2))^2, since (1 + x/2)^2 <=
// exp(x): GGX's shape with 2 alpha^2 for alpha^2. Where that exceeds 1 it grows towards grazing facets, up to
// (2 alpha^2)^2 times.
float Microfacet::falloff_alpha2() const {
  const float wide = std::max(alpha_u, alpha_v);
  return std::min(1.0f, (type == MicrofacetType::ggx ? 1 : 2) * wide * wide);
}

float Microfacet::falloff_peak() const {
  const float wide = std::max(alpha_u, alpha_v), wide2 = (type == MicrofacetType::ggx ? 1 : 2) * wide * wide;
  return std::max(1.0f, wide2 * wide2) / (k_pi * alpha_u * alpha_v);
}

float Microfacet::max_g1_over_cos(float cos_a, float cos_b) const {
  // 2 over a function that is concave or rising in the cosine: its least value is at one end. Beckmann's masking is
  // bounded by c (1 + erf(c/s)) + s exp(-(c/s)^2)/sqrt(pi) >= c + sqrt((2 c^2 + s^2)/pi).
  const float alpha2 = roughness() * roughness();
  const auto bound = [&](float c) {
    const float s2 = alpha2 * (1 - c * c);
    return 2 / (c + (type == MicrofacetType::ggx ? std::sqrt(c * c + s2) : std::sqrt((2 * c * c + s2) * k_inv_pi)));
  };
  return std::max(bound(cos_a), bound(cos_b));
}

}  // namespace gradslc
