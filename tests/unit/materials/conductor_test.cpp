#include "materials/conductor.h"

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

TEST(Conductor, MirrorsTheDirection) {
  const Conductor copper{Rgb(0.2004f, 0.9240f, 1.1022f), Rgb(3.9129f, 2.4528f, 2.1421f), Rgb(0.5f)};
  const Vec3 wo = normalize(Vec3{0.3f, -0.4f, 0.6f});
  const auto sample = copper.sample(wo);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, (Vec3{-wo.x, -wo.y, wo.z}));
  EXPECT_TRUE(sample->delta);
  EXPECT_EQ(sample->weight, copper.fresnel(wo.z));
  EXPECT_NEAR(sample->weight.b, 0.5 * fresnel_by_definition(wo.z, 1.1022, 2.1421), 1e-6);
  EXPECT_FALSE(copper.sample({wo.x, wo.y, -wo.z}));
  EXPECT_FALSE(copper.sample({1, 0, 0}));
}

TEST(Conductor, MaterialNoneReflectsAll) {
  const Conductor mirror{Rgb(0.0f), Rgb(1.0f)};
  for (const float cos_theta : {0.0f, 0.3f, 1.0f}) EXPECT_EQ(mirror.fresnel(cos_theta), Rgb(1));
}

}  // namespace
}  // namespace gradslc
