#include "materials/lobes/oren_nayar.h"

#include <algorithm>
#include <cmath>

namespace gradslc {
namespace {

float sine(const Vec3& w) { return std::sqrt(w.x * w.x + w.y * w.y); }

/// numerator / denominator, at most k_max_tangent; both >= 0.
float bounded_tangent(float numerator, float denominator) {
  return numerator >= OrenNayar::k_max_tangent * denominator ? OrenNayar::k_max_tangent : numerator / denominator;
}

constexpr float cubed(float x) { return x * x * x; }

}  // namespace

OrenNayar::OrenNayar(Rgb albedo, float alpha, bool fast_approximation) : albedo_(albedo) {
  const float sigma2 = 0.5f * alpha * alpha;
  c1_ = 1 - 0.5f * sigma2 / (sigma2 + 0.33f);
  c2_ = 0.45f * sigma2 / (sigma2 + 0.09f);
  c3_ = fast_approximation ? 0 : 0.125f * sigma2 / (sigma2 + 0.09f);
  c4_ = fast_approximation ? 0 : 0.17f * sigma2 / (sigma2 + 0.13f);
}

Rgb OrenNayar::eval(const Vec3& wo, const Vec3& wi) const {
  if (wo.z <= 0 || wi.z <= 0) return Rgb();
  const float sin_o = sine(wo), sin_i = sine(wi);
  const float cos_phi =
      sin_o > 0 && sin_i > 0 ? std::clamp((wo.x * wi.x + wo.y * wi.y) / (sin_o * sin_i), -1.0f, 1.0f) : 0;
  const bool i_steeper = wi.z > wo.z;  // alpha is the angle that is larger, beta the smaller one
  const float sin_alpha = i_steeper ? sin_o : sin_i, sin_beta = i_steeper ? sin_i : sin_o;
  const float tan_beta = bounded_tangent(sin_beta, i_steeper ? wi.z : wo.z);
  if (c3_ == 0) return albedo_ * (k_inv_pi * (c1_ + c2_ * std::max(cos_phi, 0.0f) * sin_alpha * tan_beta));
  const float alpha = std::atan2(sin_alpha, i_steeper ? wo.z : wi.z),
              beta = std::atan2(sin_beta, i_steeper ? wi.z : wo.z);
  const float c2 = c2_ * (cos_phi >= 0 ? sin_alpha : sin_alpha - cubed(2 * beta * k_inv_pi));
  const float angles = 4 * alpha * beta * k_inv_pi * k_inv_pi;
  const float tan_half = bounded_tangent(sin_alpha + sin_beta, wo.z + wi.z);
  const float single = c1_ + cos_phi * c2 * tan_beta + (1 - std::abs(cos_phi)) * c3_ * angles * angles * tan_half;
  const float twice = c4_ * (1 - cos_phi * (2 * beta * k_inv_pi) * (2 * beta * k_inv_pi));
  return k_inv_pi * (albedo_ * single + albedo_ * albedo_ * twice);
}

std::optional<BsdfSample> OrenNayar::sample(const Vec3& known, float /*u_choice*/, Vec2 u, Transport) const {
  if (known.z <= 0) return std::nullopt;
  const Vec3 w = square_to_cosine_hemisphere(u);
  if (w.z <= 0) return std::nullopt;
  return BsdfSample{w, k_pi * eval(known, w), cosine_hemisphere_pdf_solid_angle(w.z), false};
}

// beta is at most known's angle t, and so tan(beta) cos(w) <= sin(t). The third term never exceeds 0.56 of the largest
// that the second one has: c3 = 0.278 c2, its angles' factor is at most sin^2(t), tan((alpha + beta)/2) at most
// 2/cos(t).
ReflectionBound OrenNayar::reflection_bound(const Vec3& known) const {
  if (known.z <= 0) return {};
  const float rho = max_channel(albedo_);
  return {.cosine = rho * c1_ + 2 * rho * rho * c4_, .constant = rho * c2_ * sine(known)};
}

float OrenNayar::max_pi_f(const Vec3& known) const {
  if (known.z <= 0) return 0;
  const float rho = max_channel(albedo_);
  return rho * (c1_ + c2_ * bounded_tangent(sine(known), known.z)) + 2 * rho * rho * c4_;
}

}  // namespace gradslc
