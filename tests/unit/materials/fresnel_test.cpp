#include "materials/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "support/random.h"

namespace gradslc {
namespace {

/// Fresnel's equations as they are written: complex refractive index eta + i k, mean of both polarisations.
double fresnel_by_definition(double cos_i, double eta, double k) {
  const std::complex<double> index(eta, k);
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (index * index));
  const auto perpendicular = (cos_i - index * cos_t) / (cos_i + index * cos_t);
  const auto parallel = (index * cos_i - cos_t) / (index * cos_i + cos_t);
  return (std::norm(perpendicular) + std::norm(parallel)) / 2;
}

TEST(FresnelConductor, AtNormalIncidence) {
  for (const float eta : {0.2f, 1.0f, 1.5f, 3.0f})
    for (const float k : {0.0f, 0.5f, 2.1421f, 7.0f}) {
      const float expected = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
      EXPECT_NEAR(fresnel_conductor(1, eta, k), expected, 1e-6f) << eta << " " << k;
    }
}

TEST(FresnelConductor, FollowsFresnelsEquations) {
  TestRandom random(1);
  for (int i = 0; i < 10'000; ++i) {
    const float cos_i = random.get1(), eta = 0.05f + 4 * random.get1(), k = 0.1f + 8 * random.get1();
    ASSERT_NEAR(fresnel_conductor(cos_i, eta, k), fresnel_by_definition(cos_i, eta, k), 2e-5)
        << cos_i << " " << eta << " " << k;
  }
}

TEST(FresnelConductor, ReflectsAllAtGrazingIncidence) {
  for (const float eta : {0.2f, 1.5f, 3.0f}) EXPECT_NEAR(fresnel_conductor(0, eta, 2), 1, 1e-6f);
}

TEST(FresnelDielectric, HasKnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f).reflectance, 0.04f, 1e-6f);  // glass, from either side
  EXPECT_NEAR(fresnel_dielectric(-1, 1.5f).reflectance, 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1, 1.333f).reflectance, 0.02037f, 1e-5f);  // water
  EXPECT_NEAR(fresnel_dielectric(1, 1).reflectance, 0, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(0.3f, 1).cos_transmitted, -0.3f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1e-6f, 1.5f).reflectance, 1, 1e-4f);
  EXPECT_EQ(fresnel_dielectric(0, 1.5f).reflectance, 1);
  // At Brewster's angle, tan = eta, no light polarised in the plane is reflected.
  const float cos_brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);
  const float perpendicular = (1 - 1.5f * 1.5f) / (1 + 1.5f * 1.5f);
  EXPECT_NEAR(fresnel_dielectric(cos_brewster, 1.5f).reflectance, 0.5f * perpendicular * perpendicular, 1e-6f);
}

TEST(FresnelDielectric, FollowsFresnelsEquationsAndSnellsLaw) {
  TestRandom random(2);
  for (int i = 0; i < 10'000; ++i) {
    const float cos_i = 2 * random.get1() - 1, eta = 0.4f + 2 * random.get1();
    const double ratio = cos_i > 0 ? eta : 1 / double{eta};
    const double sin_t = std::sqrt(1 - double{cos_i} * cos_i) / ratio;
    const DielectricFresnel fresnel = fresnel_dielectric(cos_i, eta);
    if (sin_t > 1 + 1e-6) {
      ASSERT_EQ(fresnel.reflectance, 1);
      ASSERT_EQ(fresnel.cos_transmitted, 0);
    } else if (sin_t < 1 - 1e-4) {
      ASSERT_NEAR(fresnel.reflectance, fresnel_by_definition(std::abs(cos_i), ratio, 0), 1e-4);
      ASSERT_NEAR(std::abs(fresnel.cos_transmitted), std::sqrt(1 - sin_t * sin_t), 2e-4);
      ASSERT_LE(fresnel.cos_transmitted * cos_i, 0);
    }
  }
}

TEST(FresnelDielectric, IsTheSameFromBothEndsOfARefractedPath) {
  for (const float cos_i : {0.05f, 0.3f, 0.8f, 1.0f}) {
    const DielectricFresnel in = fresnel_dielectric(cos_i, 1.5f);
    const DielectricFresnel out = fresnel_dielectric(in.cos_transmitted, 1.5f);
    EXPECT_NEAR(out.reflectance, in.reflectance, 1e-5f);
    EXPECT_NEAR(out.cos_transmitted, cos_i, 1e-5f);
  }
}

/// 2 F(cos) cos dcos by the midpoint rule.
double diffuse_by_summation(float eta) {
  constexpr int n = 400'000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    const double ratio = eta, sin_t = std::sqrt(1 - c * c) / ratio;
    sum += 2 * c * (sin_t >= 1 ? 1 : fresnel_by_definition(c, ratio, 0));
  }
  return sum / n;
}

TEST(DiffuseFresnelReflectance, IsTheIntegralOfFresnelsReflectance) {
  for (const float eta : {1.05f, 1.3f, 1.5f, 2.419f})
    for (const float side : {eta, 1 / eta})
      EXPECT_NEAR(diffuse_fresnel_reflectance(side), diffuse_by_summation(side), 1e-5) << side;
  EXPECT_NEAR(diffuse_fresnel_reflectance(1.5f), 0.0918, 1e-4);  // d'Eon and Irving 2011
  EXPECT_NEAR(diffuse_fresnel_reflectance(1 / 1.5f), 0.5964, 1e-4);
}

}  // namespace
}  // namespace gradslc
