#include "materials/lobes/oren_nayar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace gradslc {
namespace {

Vec3 direction(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

/// pi f as the paper writes it (Oren and Nayar 1994, equations 25 to 29), angles in radians.
double by_definition(double rho, double sigma, double theta_i, double theta_r, double phi) {
  const double pi = std::acos(-1.0), s2 = sigma * sigma, c = std::cos(phi);
  const double alpha = std::max(theta_i, theta_r), beta = std::min(theta_i, theta_r);
  const double c1 = 1 - 0.5 * s2 / (s2 + 0.33);
  const double c2 = 0.45 * s2 / (s2 + 0.09) * (c >= 0 ? std::sin(alpha) : std::sin(alpha) - std::pow(2 * beta / pi, 3));
  const double c3 = 0.125 * s2 / (s2 + 0.09) * std::pow(4 * alpha * beta / (pi * pi), 2);
  return rho * (c1 + c * c2 * std::tan(beta) + (1 - std::abs(c)) * c3 * std::tan((alpha + beta) / 2)) +
         0.17 * rho * rho * s2 / (s2 + 0.13) * (1 - c * std::pow(2 * beta / pi, 2));
}

TEST(OrenNayar, FollowsThePaper) {
  TestRandom random(1);
  for (int i = 0; i < 10'000; ++i) {
    const float alpha = 0.8f * random.get1(), rho = random.get1();
    const double theta_i = 1.55 * random.get1(), theta_r = 1.55 * random.get1(), phi = 6.28 * random.get1();
    const OrenNayar lobe(Rgb(rho), alpha, false);
    const double expected = by_definition(rho, alpha / std::sqrt(2.0), theta_i, theta_r, phi);
    ASSERT_NEAR(k_pi * lobe.eval(direction(theta_r, 1), direction(theta_i, 1 + phi)).g, expected,
                2e-3 * expected + 1e-4);
  }
}

TEST(OrenNayar, HasItsQualitativeForm) {
  TestRandom random(2);
  for (int i = 0; i < 10'000; ++i) {
    const double alpha = 0.8 * random.get1(), s2 = alpha * alpha / 2;
    const double theta_i = 1.55 * random.get1(), theta_r = 1.55 * random.get1(), phi = 6.28 * random.get1();
    const OrenNayar lobe(Rgb(0.5f), static_cast<float>(alpha), true);
    const double expected = 0.5 * (1 - 0.5 * s2 / (s2 + 0.33) +
                                   0.45 * s2 / (s2 + 0.09) * std::max(0.0, std::cos(phi)) *
                                       std::sin(std::max(theta_i, theta_r)) * std::tan(std::min(theta_i, theta_r)));
    ASSERT_NEAR(k_pi * lobe.eval(direction(theta_r, 1), direction(theta_i, 1 + phi)).g, expected, 2e-3 * expected);
  }
}

TEST(OrenNayar, IsLambertWhereItIsSmooth) {
  TestRandom random(3);
  for (const bool fast : {false, true}) {
    const OrenNayar lobe(Rgb(0.7f), 0, fast);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 wo = random.direction(), wi = random.direction();
      ASSERT_NEAR(lobe.eval(wo, wi).g, wo.z > 0 && wi.z > 0 ? 0.7f * k_inv_pi : 0, 1e-6f);
    }
  }
}

}  // namespace
}  // namespace gradslc
