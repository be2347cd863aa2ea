// Properties that every BSDF must have, on one typed list. A BSDF in the registry that is not in the list fails.

#include "materials/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "support/direction_test.h"
#include "support/random.h"
#include "support/statistics.h"
#include "unit/materials/bsdf_cases.h"

namespace gradslc {
namespace {

std::vector<LobeSelection> selections() {
  const LobeSelection all;
  return {all, all.only_connectable(), all.only_other()};
}

bool scatters_from(const BsdfCase& c, Vec3 known) { return known.z > 0 || c.traits.both_sides; }

/// Anywhere on the sphere, often near the horizon.
Vec3 any_direction(TestRandom& random) {
  Vec3 w = random.direction();
  if (random.get1() < 0.3f) w.z *= std::pow(10.0f, -6 * random.get1());
  return normalize(w);
}

/// The same, often where the BSDF sends much light.
Vec3 likely_direction(const Bsdf& bsdf, Vec3 known, const LobeSelection& lobes, TestRandom& random) {
  const float u_lobe = random.get1();
  const Vec2 u = random.get2();
  const auto sample = random.get1() < 0.7f ? bsdf.sample(known, u_lobe, u, lobes) : std::nullopt;
  return sample ? sample->direction : any_direction(random);
}

void expect_near(Rgb a, Rgb b, float relative) {
  for (int channel = 0; channel < 3; ++channel)
    ASSERT_NEAR(a[channel], b[channel], relative * std::max(a[channel], b[channel]) + 1e-30f);
}

class EveryBsdf : public testing::TestWithParam<BsdfCase> {};
INSTANTIATE_TEST_SUITE_P(Bsdfs, EveryBsdf, testing::ValuesIn(bsdf_cases()),
                         [](const auto& bsdf_case) { return std::string(bsdf_case.param.name); });

TEST(BsdfRegistry, IsUnderTestAsAWhole) {
  std::set<std::string> registered, tested;
  for (const BsdfEntry& entry : bsdf_registry()) registered.insert(entry.name);
  for (const BsdfCase& c : bsdf_cases()) tested.insert(c.registered);
  EXPECT_EQ(registered, tested);
}

// False alarm 0.1 % for each BSDF. The non-delta samples are tested: those of delta lobes count as what the density
// lacks.
TEST_P(EveryBsdf, SamplesFollowTheirDensity) {
  const auto directions = known_directions();
  std::uint64_t seed = 1;
  for (const Vec3 seen : directions) {
    const auto [bsdf, known] = seen_from(GetParam(), seen);
    for (const LobeSelection& lobes : selections()) {
      ++seed;
      if (!bsdf.has(lobes)) continue;
      const auto sample = [&, known = known, &bsdf = bsdf](TestRandom& random) -> std::optional<Vec3> {
        const float u_lobe = random.get1();
        const auto drawn = bsdf.sample(known, u_lobe, random.get2(), lobes);
        return drawn && !drawn->delta ? std::optional(drawn->direction) : std::nullopt;
      };
      const auto pdf = [&, known = known, &bsdf = bsdf](Vec3 w) { return bsdf.pdf_solid_angle(known, w, lobes); };
      const ChiSquare result =
          chi_square_directions(sample, pdf, {.cells_z = 12, .cells_phi = 24, .samples = 20'000, .seed = seed});
      EXPECT_GT(result.p_value, sidak(1e-3, directions.size() * selections().size())) << "known.z = " << known.z;
    }
  }
}

TEST_P(EveryBsdf, SampleAgreesWithEvalAndDensity) {
  TestRandom random(2);
  for (const Transport transport : {Transport::radiance, Transport::particles})
    for (const Vec3 seen : known_directions()) {
      const auto [bsdf, known] = seen_from(GetParam(), seen);
      for (const LobeSelection& lobes : selections())
        for (int i = 0; i < 1000; ++i) {
          const float u_lobe = random.get1();
          const auto sample = bsdf.sample(known, u_lobe, random.get2(), lobes, transport);
          if (!sample) continue;
          const Vec3 w = sample->direction;
          ASSERT_TRUE(scatters_from(GetParam(), seen));
          ASSERT_NEAR(length(w), 1, 1e-5f);
          ASSERT_GT(sample->pdf_solid_angle, 0);
          if (!GetParam().traits.transmits) {
            ASSERT_GT(known.z * w.z, 0);
          }
          if (sample->delta) {
            ASSERT_LE(sample->pdf_solid_angle, 1);
            continue;
          }
          const float pdf = bsdf.pdf_solid_angle(known, w, lobes);
          const Rgb f = transport == Transport::radiance ? bsdf.eval(known, w, lobes) : bsdf.eval(w, known, lobes);
          ASSERT_NEAR(sample->pdf_solid_angle, pdf, 1e-4f * pdf);
          // 1e-3: where facets graze, rounding of the half vector costs digits.
          expect_near(sample->weight, f * (std::abs(w.z) / pdf), 1e-3f);
        }
    }
}

// f(wo, wi) / eta_o^2 is symmetric (Veach 1997, section 5.2).
TEST_P(EveryBsdf, IsReciprocal) {
  const float eta2 = GetParam().traits.eta * GetParam().traits.eta;
  TestRandom random(3);
  const LobeSelection all;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 seen = random.direction();
    const auto [bsdf, known] = seen_from(GetParam(), seen);
    const Vec3 w = likely_direction(bsdf, known, all, random);
    const float eta2_known = known.z > 0 ? 1 : eta2, eta2_w = w.z > 0 ? 1 : eta2;
    expect_near(bsdf.eval(known, w, all) / eta2_known, bsdf.eval(w, known, all) / eta2_w, 1e-3f);
    if (!GetParam().traits.transmits && known.z * w.z < 0) {
      ASSERT_EQ(bsdf.eval(known, w, all), Rgb());
    }
  }
}

// Particles never gain, what passes straight through included; white delta and Lambertian BSDFs lose nothing, whatever
// is drawn.
TEST_P(EveryBsdf, KeepsItsEnergy) {
  const BsdfCase& c = GetParam();
  const LobeSelection all;
  TestRandom random(4);
  for (const Vec3 seen : known_directions()) {
    const auto [bsdf, known] = seen_from(c, seen);
    Moments channels[3];
    for (int i = 0; i < 4000; ++i) {
      const float u_lobe = random.get1();
      const auto sample = bsdf.sample(known, u_lobe, random.get2(), all, Transport::particles);
      const Rgb weight = (sample ? sample->weight : Rgb()) + bsdf.straight_transmittance();
      for (int channel = 0; channel < 3; ++channel) channels[channel].add(weight[channel]);
      if (c.traits.white && scatters_from(c, seen)) {
        ASSERT_NEAR(max_channel(weight), 1, 1e-6f);
      }
    }
    const float energy = bsdf.energy(known, all) + max_channel(bsdf.straight_transmittance());
    if (!scatters_from(c, seen)) {
      EXPECT_EQ(energy, 0);
      EXPECT_EQ(channels[0].mean(), 0);
    } else if (c.traits.white) {
      EXPECT_NEAR(energy, 1, 1e-6f);
    } else {
      EXPECT_GT(energy, 0);
      EXPECT_LT(energy, 2);
    }
    for (const Moments& carried : channels) EXPECT_LT(carried.mean(), 1 + 4 * carried.standard_error() + 1e-6);
  }
}

// What the samples carry is the integral of f |cos|, in both transports, and the density's integral is at most 1. False
// alarm 0.1 % for each BSDF.
TEST_P(EveryBsdf, CarriesTheIntegralOfEval) {
  const LobeSelection all;
  TestRandom random(5);
  for (const Vec3 seen : {normalize(Vec3{0.3f, 0.4f, 0.6f}), normalize(Vec3{-0.8f, 0.2f, -0.5f})}) {
    const auto [bsdf, known] = seen_from(GetParam(), seen);
    EXPECT_LE(
        integrate_over_sphere([&, known = known, &bsdf = bsdf](Vec3 w) { return bsdf.pdf_solid_angle(known, w, all); }),
        1 + 1e-3);
    for (const Transport transport : {Transport::radiance, Transport::particles}) {
      const bool radiance = transport == Transport::radiance;
      const double integral = integrate_over_sphere([&, known = known, &bsdf = bsdf](Vec3 w) {
        return std::abs(w.z) * (radiance ? bsdf.eval(known, w, all) : bsdf.eval(w, known, all)).g;
      });
      Moments carried;
      for (int i = 0; i < 20'000; ++i) {
        const float u_lobe = random.get1();
        const auto sample = bsdf.sample(known, u_lobe, random.get2(), all, transport);
        carried.add(sample && !sample->delta ? sample->weight.g : 0);
      }
      // The quadrature has an error of 1e-3 where lobes are sharp.
      const double excess = std::max(0.0, std::abs(carried.mean() - integral) - 1e-3 * integral);
      EXPECT_GT(Moments(carried).p_value(carried.mean() - excess), sidak(1e-3, 4)) << integral << " " << carried.mean();
    }
  }
}

// The connectable and the other lobes together are the BSDF, whatever the threshold, and each lobe is in one of them.
TEST_P(EveryBsdf, LobeSelectionSplitsItExactly) {
  TestRandom random(6);
  for (const float threshold : {1e-6f, 0.05f, 0.1f, 0.5f, 1e6f}) {
    LobeSelection all;
    all.connectable_roughness = threshold;
    for (int i = 0; i < 2000; ++i) {
      const auto [bsdf, known] = seen_from(GetParam(), random.direction());
      const Vec3 w = likely_direction(bsdf, known, all, random);
      const Bsdf::Split split = bsdf.eval_split(known, w, all);
      EXPECT_EQ(split.connectable, bsdf.eval(known, w, all.only_connectable()));
      EXPECT_EQ(split.other, bsdf.eval(known, w, all.only_other()));
      expect_near(bsdf.eval(known, w, all.only_connectable()) + bsdf.eval(known, w, all.only_other()),
                  bsdf.eval(known, w, all), 1e-6f);
    }
    for (const Vec3 seen : known_directions()) {
      const auto [bsdf, known] = seen_from(GetParam(), seen);
      EXPECT_EQ(bsdf.has(all), bsdf.has(all.only_connectable()) || bsdf.has(all.only_other()));
      for (const LobeSelection& lobes : {all.only_connectable(), all.only_other()}) {
        const bool scatters = bsdf.energy(known, lobes) > 0;
        EXPECT_LE(scatters, bsdf.has(lobes));
        if (seen.z > 0) {
          EXPECT_EQ(scatters, bsdf.has(lobes));
        }
        bool sampled = false;
        for (int i = 0; i < 2000 && !sampled; ++i) {
          const float u_lobe = random.get1();
          sampled = bsdf.sample(known, u_lobe, random.get2(), lobes).has_value();
        }
        EXPECT_EQ(sampled, scatters);
      }
    }
  }
}

/// The bound for a direction; sin^2(g/2) from the chord, exact for small angles.
float towards(const GlossBound& bound, Vec3 image, Vec3 w) {
  if (bound.peak == 0) return 0;
  const float s2 = length_squared(image - w) / 4;
  return std::min(bound.peak, bound.tail * gloss_falloff(s2, bound.alpha2));
}

TEST_P(EveryBsdf, IsBoundedByItsBounds) {
  const Material& material = *GetParam().material;
  TestRandom random(7);
  for (const float threshold : {0.01f, 0.1f, 0.35f}) {
    LobeSelection lobes;
    lobes.connectable_roughness = threshold;
    const LobeSelection connectable = lobes.only_connectable();
    const float everywhere = material.max_connectable_pi_f(lobes);
    ASSERT_TRUE(std::isfinite(everywhere));
    for (int i = 0; i < 1000; ++i) {
      const auto [bsdf, known] = seen_from(GetParam(), any_direction(random));
      const ReflectionBound bound = bsdf.connectable_bound(known, lobes);
      const ValueBound value_bound = bsdf.connectable_value_bound(known, lobes);
      const float largest = value_bound.max();
      ASSERT_TRUE(std::isfinite(bound.cosine) && std::isfinite(bound.constant) && std::isfinite(bound.gloss.peak));
      ASSERT_TRUE(std::isfinite(largest) && std::isfinite(value_bound.gloss.tail));
      const Vec3 image = mirrored(known, {0, 0, 1});
      for (int j = 0; j < 50; ++j) {
        const Vec3 w = likely_direction(bsdf, known, connectable, random);
        const float cos_w = std::abs(w.z);
        for (const Rgb f : {bsdf.eval(known, w, connectable), bsdf.eval(w, known, connectable)}) {
          const float pi_f = k_pi * max_channel(f);
          ASSERT_LE(pi_f, largest * 1.00001f) << known.z << " " << w.z;
          ASSERT_LE(pi_f, (value_bound.broad + towards(value_bound.gloss, image, w)) * 1.00001f) << known.z << w.z;
          ASSERT_LE(pi_f * cos_w, (bound.cosine * cos_w + bound.constant + towards(bound.gloss, image, w)) * 1.00001f)
              << known.z << " " << w.z;
          ASSERT_LE(pi_f, everywhere * 1.00001f) << known.z << " " << w.z;
        }
      }
    }
    EXPECT_EQ(material.max_connectable_pi_f(lobes) > 0, seen_from(GetParam(), {0, 0, 1}).bsdf.has(connectable) ||
                                                            seen_from(GetParam(), {0, 0, -1}).bsdf.has(connectable));
  }
}

TEST_P(EveryBsdf, IsWhatItsMaterialSays) {
  const Material& material = *GetParam().material;
  for (const float threshold : {0.01f, 0.1f, 0.35f}) {
    LobeSelection lobes;
    lobes.connectable_roughness = threshold;
    bool others = false, transmits = false, crosses = false;
    for (const Vec3 known : {Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
      const Bsdf bsdf = seen_from(GetParam(), known).bsdf;
      others |= bsdf.has(lobes.only_other());
      crosses |= !is_black(bsdf.straight_transmittance());
      transmits |= crosses || bsdf.transmits(lobes);
      EXPECT_LE(static_cast<int>(bsdf.entries().size()), material.max_lobes());
    }
    EXPECT_EQ(material.has_other_lobes(lobes), others);
    EXPECT_EQ(material.transmits(), transmits);
    EXPECT_EQ(material.crosses(), crosses);
    EXPECT_EQ(transmits, GetParam().traits.transmits);
  }
}

// Paths pass on in proportion to what passes, and the same light passes in either sense.
TEST_P(EveryBsdf, LetsLightPassInEitherSense) {
  for (const Vec3 seen : known_directions()) {
    const auto [bsdf, known] = seen_from(GetParam(), seen);
    const float passes = max_channel(bsdf.straight_transmittance()), scatters = bsdf.energy(known, LobeSelection());
    expect_near(bsdf.straight_transmittance(), seen_from(GetParam(), -seen).bsdf.straight_transmittance(), 1e-6f);
    EXPECT_EQ(bsdf.pass_probability(known) > 0, passes > 0);
    EXPECT_NEAR(bsdf.pass_probability(known) * (passes + scatters), passes, 1e-6f);
    TestRandom random(9);
    for (int i = 0; i < 200; ++i) {  // crossings are no lobes
      const float u_lobe = random.get1();
      const auto sample = bsdf.sample(known, u_lobe, random.get2(), LobeSelection());
      ASSERT_FALSE(GetParam().material->crosses() && sample && sample->delta && sample->direction == -known);
    }
  }
}

TEST_P(EveryBsdf, IsBlackFromBehindUnlessItIsNot) {
  if (GetParam().traits.both_sides) return;
  const LobeSelection all;
  TestRandom random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 above = any_direction(random), w = any_direction(random);
    const auto [bsdf, known] = seen_from(GetParam(), {above.x, above.y, -std::abs(above.z)});
    ASSERT_EQ(bsdf.eval(known, w, all), Rgb());
    ASSERT_EQ(bsdf.eval(w, known, all), Rgb());
    ASSERT_EQ(bsdf.pdf_solid_angle(known, w, all), 0);
    const float u_lobe = random.get1();
    ASSERT_FALSE(bsdf.sample(known, u_lobe, random.get2(), all));
  }
}

}  // namespace
}  // namespace gradslc
