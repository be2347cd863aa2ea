// Plastics: a diffuse base under a coat, smooth or rough.

#include "materials/lobes/coated_diffuse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/plugins.h"
#include "support/direction_test.h"
#include "unit/materials/fake_properties.h"

namespace gradslc {
namespace {

const LobeSelection k_all;

Bsdf bsdf_of(const MaterialPtr& material) { return shade(*material, {0, 0, 1}).bsdf; }

double transmitted_share(const RoughDielectric& glass, Vec3 wi) {
  return integrate_over_sphere([&](Vec3 wo) { return wo.z * wi.z < 0 ? std::abs(wo.z) * glass.eval(wo, wi).g : 0; });
}

TEST(RoughTransmittance, IsTheIntegralOfTheRefractedLight) {
  for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann})
    for (const float alpha : {0.05f, 0.2f, 0.6f})
      for (const float eta : {1.3f, 1.5f}) {
        const Microfacet microfacet{type, alpha, alpha};
        const RoughTransmittance transmittance(microfacet, eta);
        for (const float c : {0.03f, 0.2f, 0.55f, 0.97f}) {
          const Vec3 wi{std::sqrt(1 - c * c), 0, c};
          EXPECT_NEAR(transmittance(c), transmitted_share({microfacet, eta}, wi), 1e-3)
              << alpha << " " << eta << " " << c;
        }
      }
}

TEST(RoughTransmittance, FromInsideFollowsFromReciprocity) {
  const Microfacet microfacet{MicrofacetType::ggx, 0.3f, 0.3f};
  const RoughTransmittance outside(microfacet, 1.5f), inside(microfacet, 1 / 1.5f);
  EXPECT_NEAR(outside.escaping(), inside.diffuse(), 1e-3);
  double sum = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i) sum += 2 * (i + 0.5) / n * outside((static_cast<float>(i) + 0.5f) / n);
  EXPECT_NEAR(outside.diffuse(), sum / n, 1e-4);
}

TEST(RoughTransmittance, IsFresnelsWhereTheCoatIsNearlySmooth) {
  for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
    const RoughTransmittance transmittance({type, 0.001f, 0.001f}, 1.5f);
    for (const float c : {0.05f, 0.3f, 0.7f, 1.0f})
      EXPECT_NEAR(transmittance(c), 1 - fresnel_dielectric(c, 1.5f).reflectance, 1e-3) << c;
    EXPECT_NEAR(transmittance.diffuse(), 1 - diffuse_fresnel_reflectance(1.5f), 1e-3);
  }
}

TEST(RoughPlastic, IsPlasticWhereItIsNearlySmooth) {
  const Texture grey(Rgb(0.2f, 0.5f, 0.8f));
  for (const bool nonlinear : {false, true}) {
    const Bsdf smooth = bsdf_of(make_plastic(1.5f, grey, nonlinear));
    const MaterialPtr material = make_rough_plastic(MicrofacetType::ggx, 0.001f, 1.5f, grey, nonlinear);
    const Bsdf rough = bsdf_of(material);  // refers to its material's table
    const LobeSelection diffuse = k_all.only_connectable();
    TestRandom random(1);
    for (int i = 0; i < 100; ++i) {
      const Vec3 wo = random.direction(), wi = random.direction();
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(rough.eval(wo, wi, diffuse)[channel], smooth.eval(wo, wi, diffuse)[channel], 2e-3f);
    }
  }
}

// At normal incidence T = 0.96; the base is dimmed by what comes back to it (Mitsuba's plastic).
TEST(Plastic, HasKnownValues) {
  const float internal = diffuse_fresnel_reflectance(1 / 1.5f);
  const Vec3 up{0, 0, 1};
  const Bsdf linear = bsdf_of(make_plastic(1.5f, Texture(Rgb(0.5f)), false));
  EXPECT_NEAR(linear.eval(up, up, k_all).g, 0.5f / (1 - internal) * 0.96f * 0.96f / 2.25f * k_inv_pi, 1e-5f);
  const Bsdf nonlinear = bsdf_of(make_plastic(1.5f, Texture(Rgb(0.5f)), true));
  EXPECT_NEAR(nonlinear.eval(up, up, k_all).g, 0.5f / (1 - 0.5f * internal) * 0.96f * 0.96f / 2.25f * k_inv_pi, 1e-5f);
  const auto coat = linear.sample(up, 0, {}, k_all.only_other()).value();
  EXPECT_NEAR(coat.weight.g, 0.04f, 1e-6f);
}

// White furnace: with a white base that throws nothing away, all light comes back.
TEST(Plastic, LosesNothingWhereItsBaseIsWhite) {
  const Bsdf plastic = bsdf_of(make_plastic(1.5f, Texture(Rgb(1)), true));
  for (const float c : {0.1f, 0.4f, 1.0f}) {
    const Vec3 known{std::sqrt(1 - c * c), 0, c};
    const double diffuse =
        integrate_over_sphere([&](Vec3 w) { return std::max(w.z, 0.0f) * plastic.eval(known, w, k_all).g; });
    EXPECT_NEAR(diffuse + plastic.energy(known, k_all.only_other()), 1, 1e-4);
    EXPECT_NEAR(plastic.energy(known, k_all), 1, 1e-4);
  }
}

TEST(RoughPlastic, LosesLittleWhereItsBaseIsWhite) {
  for (const auto& [alpha, least] : {std::pair{0.05f, 0.98f}, {0.2f, 0.93f}, {0.5f, 0.8f}}) {
    const MaterialPtr material = make_rough_plastic(MicrofacetType::ggx, alpha, 1.5f, Texture(Rgb(1)), true);
    const Bsdf plastic = bsdf_of(material);
    for (const float c : {0.3f, 0.8f}) {
      const Vec3 known{std::sqrt(1 - c * c), 0, c};
      const double all =
          integrate_over_sphere([&](Vec3 w) { return std::max(w.z, 0.0f) * plastic.eval(known, w, k_all).g; });
      EXPECT_LT(all, 1.002);
      EXPECT_GT(all, least) << alpha << " " << c;
    }
  }
}

}  // namespace
}  // namespace gradslc
