#include "scene/lights/hosek_wilkie.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "scene/lights/hosek_wilkie_data.h"
#include "scene/lights/spectrum_to_rgb.h"

namespace gradslc {
namespace {

/// Bernstein polynomials of degree 5.
std::array<double, 6> bernstein(double x) {
  constexpr std::array<double, 6> binomials{1, 5, 10, 10, 5, 1};
  std::array<double, 6> weights{};
  for (int i = 0; i < 6; ++i)
    weights[static_cast<std::size_t>(i)] =
        binomials[static_cast<std::size_t>(i)] * std::pow(x, i) * std::pow(1 - x, 5 - i);
  return weights;
}

}  // namespace

/// Bezier in the cube root of the elevation (section 5.3), linear in turbidity and albedo between the fitted ones.
HosekWilkieSky::HosekWilkieSky(double turbidity, Rgb ground_albedo, double sun_elevation) {
  assert(turbidity >= 1 && turbidity <= 10 && sun_elevation >= 0);
  const std::array<double, 6> curve = bernstein(std::cbrt(sun_elevation / (std::numbers::pi / 2)));
  const int lower = std::min(static_cast<int>(turbidity), 9);
  for (std::size_t c = 0; c < channels_.size(); ++c)
    for (const int high_turbidity : {0, 1})
      for (const int high_albedo : {0, 1}) {
        const double albedo = ground_albedo[static_cast<int>(c)], remainder = turbidity - lower;
        const double weight = (high_turbidity ? remainder : 1 - remainder) * (high_albedo ? albedo : 1 - albedo);
        const HosekWilkieShape& shape = k_hosek_wilkie_shape[c][high_albedo][lower - 1 + high_turbidity];
        const HosekWilkieLevel& level = k_hosek_wilkie_level[c][high_albedo][lower - 1 + high_turbidity];
        for (std::size_t i = 0; i < curve.size(); ++i) {
          for (std::size_t p = 0; p < 9; ++p) channels_[c].shape[p] += weight * curve[i] * shape[i][p];
          channels_[c].level += weight * curve[i] * level[i];
        }
      }
}

/// Equations 8 and 9. The data set gives the parameters in the order A, B, C, D, E, F, G, I, H.
double HosekWilkieSky::radiance(const Channel& channel, double theta, double gamma) {
  const auto [a, b, c, d, e, f, g, i, h] = channel.shape;
  const double cos_theta = std::cos(theta), cos_gamma = std::cos(gamma), squared = cos_gamma * cos_gamma;
  const double chi = (1 + squared) / std::pow(1 + h * h - 2 * h * cos_gamma, 1.5);
  const double horizon = 1 + a * std::exp(b / (cos_theta + 0.01));
  return channel.level * horizon *
         (c + d * std::exp(e * gamma) + f * squared + g * chi + i * std::sqrt(std::max(cos_theta, 0.0)));
}

Rgb HosekWilkieSky::radiance(double theta, double gamma) const {
  const auto of = [&](std::size_t channel) {
    return static_cast<float>(std::max(0.0, radiance(channels_[channel], theta, gamma) / k_integral_of_y));
  };
  return {of(0), of(1), of(2)};
}

}  // namespace gradslc
