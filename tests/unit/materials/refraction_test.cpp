// Light that changes its medium: eta^2 of radiance, none of it for particles, and the limits of what is nearly smooth.

#include <gtest/gtest.h>

#include <cmath>

#include "materials/plugins.h"
#include "support/direction_test.h"
#include "support/statistics.h"
#include "unit/materials/fake_properties.h"

namespace gradslc {
namespace {

const LobeSelection k_all;
constexpr float k_eta = 1.5f;

Bsdf bsdf_of(const MaterialPtr& material, Vec3 known = {0, 0, 1}) { return shade(*material, known).bsdf; }

/// Mean weights of what is reflected and of what is transmitted.
struct Carried {
  Moments reflected, transmitted;
};
Carried carried(const Bsdf& bsdf, Vec3 known, Transport transport, std::uint64_t seed, int samples = 20'000) {
  TestRandom random(seed);
  Carried result;
  for (int i = 0; i < samples; ++i) {
    const float u_lobe = random.get1();
    const auto sample = bsdf.sample(known, u_lobe, random.get2(), k_all, transport);
    const bool reflected = sample && sample->direction.z * known.z > 0;
    result.reflected.add(sample && reflected ? sample->weight.g : 0);
    result.transmitted.add(sample && !reflected ? sample->weight.g : 0);
  }
  return result;
}

TEST(Glass, FollowsSnellsLaw) {
  const Bsdf glass = bsdf_of(make_dielectric(k_eta));
  for (const Vec3 known : {normalize(Vec3{0.6f, 0.3f, 0.5f}), normalize(Vec3{0.3f, -0.3f, -0.9f})}) {
    const auto refracted = glass.sample(known, 0.999f, {}, k_all).value();
    const float ratio = known.z > 0 ? k_eta : 1 / k_eta;
    EXPECT_NEAR(refracted.direction.x, -known.x / ratio, 1e-6f);
    EXPECT_NEAR(refracted.direction.y, -known.y / ratio, 1e-6f);
    EXPECT_LT(refracted.direction.z * known.z, 0);
    EXPECT_NEAR(length(refracted.direction), 1, 1e-6f);
    const auto reflected = glass.sample(known, 0, {}, k_all).value();
    EXPECT_EQ(reflected.direction, (Vec3{-known.x, -known.y, known.z}));
  }
}

TEST(Glass, ReflectsAllBeyondTheCriticalAngle) {
  const Bsdf glass = bsdf_of(make_dielectric(k_eta));
  const Vec3 inside = normalize(Vec3{1, 0, -0.5f});
  for (const float u_lobe : {0.0f, 0.5f, 0.99f}) {
    const auto sample = glass.sample(inside, u_lobe, {}, k_all).value();
    EXPECT_EQ(sample.direction, (Vec3{-inside.x, -inside.y, inside.z}));
    EXPECT_EQ(sample.weight, Rgb(1));
  }
}

// Radiance over eta^2 is constant along a refracted ray; what is refracted inwards and outwards again is as it was.
TEST(Glass, ScalesRadianceByEtaSquaredAndParticlesNotAtAll) {
  const Bsdf glass = bsdf_of(make_dielectric(k_eta));
  const Vec3 outside = normalize(Vec3{0.3f, 0, 0.8f});
  const auto in = glass.sample(outside, 0.999f, {}, k_all, Transport::radiance).value();
  EXPECT_NEAR(in.weight.g, 1 / (k_eta * k_eta), 1e-5f);  // the camera is outside: light comes from inside
  const auto out = glass.sample(in.direction, 0.999f, {}, k_all, Transport::radiance).value();
  EXPECT_NEAR(out.weight.g, k_eta * k_eta, 1e-5f);
  EXPECT_NEAR(length(out.direction - outside), 0, 1e-5f);
  EXPECT_NEAR(glass.sample(outside, 0.999f, {}, k_all, Transport::particles).value().weight.g, 1, 1e-6f);
  EXPECT_NEAR(glass.sample(in.direction, 0.999f, {}, k_all, Transport::particles).value().weight.g, 1, 1e-6f);
}

// Diffuse particles through a slab of two interfaces: inside, nothing is lost; R and T of both interfaces add up to 1.
TEST(Glass, KeepsThePowerOfParticlesInASlab) {
  const Bsdf glass = bsdf_of(make_dielectric(k_eta));
  TestRandom random(1);
  Moments passed, thrown_back;
  for (int i = 0; i < 20'000; ++i) {
    Vec3 w = square_to_cosine_hemisphere(random.get2());  // towards where the particle comes from
    float weight = 1;
    bool at_top = true, inside = false;
    do {
      // At the bottom the slab's inside is on the other side: mirror it.
      const Vec3 known = at_top ? w : Vec3{w.x, w.y, -w.z};
      const float u_lobe = random.get1();
      const auto sample = glass.sample(known, u_lobe, random.get2(), k_all, Transport::particles).value();
      weight *= sample.weight.g;
      inside = sample.direction.z < 0;
      const Vec3 direction =
          at_top ? sample.direction : Vec3{sample.direction.x, sample.direction.y, -sample.direction.z};
      if (inside) w = -direction, at_top = !at_top;
    } while (inside);
    (at_top ? thrown_back : passed).add(weight);
    ASSERT_NEAR(weight, 1, 1e-3f);
  }
  EXPECT_NEAR(passed.count() + thrown_back.count(), 20'000, 0);
  // Diffuse transmittance of a slab of two surfaces of reflectance r each, light diffuse inside only at first: between
  // that of a single interface and its square.
  const double share = static_cast<double>(passed.count()) / 20'000;
  const double single = 1 - diffuse_fresnel_reflectance(k_eta);
  EXPECT_GT(share, single * single);
  EXPECT_LT(share, single);
}

// The integral of f cos over wi is eta_o^2/eta_i^2 times the one over wo, for both sides. Independent of sample().
TEST(RoughGlass, HasTheEtaSquaredOfRadianceInEval) {
  for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
    const Bsdf glass = bsdf_of(make_rough_dielectric(type, 0.3f, k_eta));
    for (const Vec3 known : {normalize(Vec3{0.3f, 0, 0.8f}), normalize(Vec3{0.2f, 0.1f, -0.9f})}) {
      const auto transmitted = [&](bool known_is_wo) {
        return integrate_over_sphere([&](Vec3 w) {
          if (w.z * known.z > 0) return 0.0f;
          return std::abs(w.z) * (known_is_wo ? glass.eval(known, w, k_all) : glass.eval(w, known, k_all)).g;
        });
      };
      const double scale = known.z > 0 ? 1 / (k_eta * k_eta) : k_eta * k_eta;  // eta of known's side over the other's
      EXPECT_NEAR(transmitted(true) / transmitted(false), scale, 2e-3 * scale);
    }
  }
}

// False alarm 0.1 %: sampled shares against the smooth surface's, within what alpha^2 changes.
TEST(RoughGlass, IsGlassWhereItIsNearlySmooth) {
  for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann})
    for (const Vec3 known : {normalize(Vec3{0.6f, 0.3f, 0.5f}), normalize(Vec3{0.3f, -0.3f, -0.9f})})
      for (const Transport transport : {Transport::radiance, Transport::particles}) {
        const Carried smooth = carried(bsdf_of(make_dielectric(k_eta)), known, transport, 1);
        const Carried rough = carried(bsdf_of(make_rough_dielectric(type, 0.001f, k_eta)), known, transport, 2);
        EXPECT_GT(same_mean_p_value(smooth.reflected, rough.reflected), sidak(1e-3, 16));
        EXPECT_GT(same_mean_p_value(smooth.transmitted, rough.transmitted), sidak(1e-3, 16));
      }
}

TEST(RoughGlass, LosesLittleToASecondFacet) {
  for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
    float last = 1.001f;
    for (const auto& [alpha, least] : {std::pair{0.05f, 0.99f}, {0.2f, 0.93f}, {0.5f, 0.75f}}) {
      const Carried c = carried(bsdf_of(make_rough_dielectric(type, alpha, k_eta)), normalize(Vec3{1, 0, 1}),
                                Transport::particles, 3);
      const auto total = static_cast<float>(c.reflected.mean() + c.transmitted.mean());
      EXPECT_LT(total, last);
      EXPECT_GT(total, least);
      last = total;
    }
  }
}

// Albedos from an independent program that samples all facets by D, 3 million samples: error 0.001.
TEST(RoughMirror, IsAMirrorWhereItIsNearlySmoothAndLosesWhatASecondFacetTakes) {
  struct Known {
    MicrofacetType type;
    float alpha;
    double albedo;
  };
  for (const Known& known :
       {Known{MicrofacetType::ggx, 0.001f, 1}, Known{MicrofacetType::ggx, 0.1f, 0.9803},
        Known{MicrofacetType::ggx, 0.3f, 0.8394}, Known{MicrofacetType::ggx, 0.6f, 0.6054},
        Known{MicrofacetType::beckmann, 0.001f, 1}, Known{MicrofacetType::beckmann, 0.1f, 1},
        Known{MicrofacetType::beckmann, 0.3f, 0.9586}, Known{MicrofacetType::beckmann, 0.6f, 0.8353}}) {
    const Bsdf mirror = bsdf_of(make_rough_mirror(known.type, known.alpha, Texture(Rgb(1))));
    const Carried c = carried(mirror, normalize(Vec3{1, 0.5f, 1}), Transport::radiance, 4, 100'000);
    EXPECT_NEAR(c.reflected.mean(), known.albedo, 4e-3) << known.alpha;
  }
}

TEST(Pane, ReflectsAndPassesStraightWithAllItsReflectionsInside) {
  const MaterialPtr pane = make_thin_dielectric(k_eta);
  for (const Vec3 known : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, normalize(Vec3{1, 2, 3}), normalize(Vec3{1, 2, -0.3f})}) {
    const Bsdf bsdf = bsdf_of(pane, known);
    const Carried c = carried(bsdf, known, Transport::radiance, 5, 10);
    const float once = fresnel_dielectric(std::abs(known.z), k_eta).reflectance;
    EXPECT_NEAR(c.reflected.mean(), 2 * once / (1 + once), 1e-6);
    EXPECT_EQ(c.transmitted.mean(), 0) << "what passes straight through is no lobe";
    EXPECT_NEAR(bsdf.straight_transmittance().g, 1 - 2 * once / (1 + once), 1e-6f);
  }
  EXPECT_NEAR(bsdf_of(pane).straight_transmittance().g, 1 - 2 * 0.04f / 1.04f, 1e-6f);
  EXPECT_EQ(bsdf_of(make_dielectric(k_eta)).straight_transmittance(), Rgb());
}

}  // namespace
}  // namespace gradslc
