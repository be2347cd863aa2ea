#include "materials/fresnel.h"

#include <algorithm>
#include <cmath>

namespace gradslc {

float fresnel_conductor(float cos_theta, float eta, float k) {
  const float cos2 = cos_theta * cos_theta, sin2 = 1 - cos2;
  const float eta2 = eta * eta, k2 = k * k;
  const float t0 = eta2 - k2 - sin2;
  const float a2_plus_b2 = std::sqrt(t0 * t0 + 4 * eta2 * k2);
  const float a = std::sqrt(std::max(0.0f, 0.5f * (a2_plus_b2 + t0)));
  const float t1 = a2_plus_b2 + cos2;
  const float t2 = 2 * a * cos_theta;
  const float rs = (t1 - t2) / (t1 + t2);
  const float t3 = cos2 * a2_plus_b2 + sin2 * sin2;
  const float t4 = t2 * sin2;
  const float rp = rs * (t3 - t4) / (t3 + t4);
  return 0.5f * (rs + rp);
}

Rgb fresnel_conductor(float cos_theta, Rgb eta, Rgb k) {
  return {fresnel_conductor(cos_theta, eta.r, k.r), fresnel_conductor(cos_theta, eta.g, k.g),
          fresnel_conductor(cos_theta, eta.b, k.b)};
}

float diffuse_fresnel_reflectance(float eta) {
  // What passes from inside and from outside differs by eta^2, as 2 cos dcos does between both sides (Snell's law).
  // From the less dense side the integrand has no kink.
  if (eta < 1) return 1 - eta * eta * (1 - diffuse_fresnel_reflectance(1 / eta));
  constexpr int intervals =
      2048;  // of Simpson's rule over sqrt(cos), in which the integrand is smooth at grazing angles
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double x = static_cast<double>(i) / intervals;
    const double weight = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * 4 * x * x * x * fresnel_dielectric(static_cast<float>(x * x), eta).reflectance;
  }
  return static_cast<float>(sum / (3 * intervals));
}

}  // namespace gradslc
