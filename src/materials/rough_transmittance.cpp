#include "materials/rough_transmittance.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "materials/fresnel.h"

namespace gradslc {
namespace {

/// Mean over the visible facets of (1 - F) G1(refracted direction): midpoint rule over the square that they are sampled
/// from, in coordinates that are denser at its border, where steep facets are rare but shadow all.
float transmittance(const Microfacet& microfacet, float eta, float cos_theta) {
  constexpr int n = 32;
  const Vec3 wi{std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta)), 0, cos_theta};
  double sum = 0, total = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const float a = k_pi / 2 * ((2 * static_cast<float>(i) + 1) / n - 1);
      const float b = k_pi / 2 * ((2 * static_cast<float>(j) + 1) / n - 1);
      const float weight = std::cos(a) * std::cos(b);
      total += weight;
      const Vec3 m = microfacet.sample_visible(wi, {(1 + std::sin(a)) / 2, (1 + std::sin(b)) / 2});
      const float cos_i = dot(wi, m);
      if (cos_i <= 0) continue;
      const DielectricFresnel fresnel = fresnel_dielectric(cos_i, eta);
      const Vec3 wo = m * (cos_i / eta + fresnel.cos_transmitted) - wi / eta;
      if (fresnel.reflectance < 1 && wo.z < 0) sum += weight * (1 - fresnel.reflectance) * microfacet.g1(wo);
    }
  return static_cast<float>(sum / total);
}

}  // namespace

RoughTransmittance::RoughTransmittance(const Microfacet& microfacet, float eta) : inv_eta2_(1 / (eta * eta)) {
  double diffuse = 0;
  for (int i = 0; i <= k_intervals; ++i) {
    const float x = static_cast<float>(i) / k_intervals;
    const float value = i == 0 ? transmittance(microfacet, eta, 1e-6f) : transmittance(microfacet, eta, x * x);
    table_[static_cast<std::size_t>(i)] = value;
    max_ = std::max(max_, value);
    const double simpson = i == 0 || i == k_intervals ? 1 : i % 2 == 1 ? 4 : 2;
    diffuse += simpson * 4 * x * x * x * value;
  }
  diffuse_ = static_cast<float>(diffuse / (3 * k_intervals));
}

float RoughTransmittance::operator()(float cos_theta) const {
  const float x = std::sqrt(std::clamp(cos_theta, 0.0f, 1.0f)) * k_intervals;
  const int i = std::min(static_cast<int>(x), k_intervals - 1);
  const float t = x - static_cast<float>(i);
  const auto at = static_cast<std::size_t>(i);
  return (1 - t) * table_[at] + t * table_[at + 1];
}

}  // namespace gradslc
