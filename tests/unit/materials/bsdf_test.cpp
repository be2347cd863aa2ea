// Properties that every BSDF must have, on one typed list. A BSDF in the registry that is not in the list fails.

#include "materials/bsdf.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "materials/material.h"
#include "support/direction_test.h"
#include "support/random.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

struct BsdfCase {
  const char* name;        ///< of the case
  const char* registered;  ///< name in bsdf_registry()
  Bsdf bsdf;
  bool both_sides;  ///< reflects light that comes to either side
  bool white;       ///< loses no energy, exactly
};

void PrintTo(const BsdfCase& c, std::ostream* stream) { *stream << c.name; }

/// The only list of BSDFs under test.
std::vector<BsdfCase> bsdf_cases() {
  const Conductor copper{Rgb(0.2004f, 0.9240f, 1.1022f), Rgb(3.9129f, 2.4528f, 2.1421f)};
  const Conductor mirror{Rgb(0.0f), Rgb(1.0f)};
  return {
      {"diffuse_grey", "diffuse", Bsdf(Diffuse{Rgb(0.2f, 0.5f, 0.8f)}, false), false, false},
      {"diffuse_white", "diffuse", Bsdf(Diffuse{Rgb(1)}, false), false, true},
      {"diffuse_two_sided", "twosided", Bsdf(Diffuse{Rgb(0.2f, 0.5f, 0.8f)}, true), true, false},
      {"conductor_copper", "conductor", Bsdf(copper, false), false, false},
      {"conductor_mirror", "conductor", Bsdf(mirror, false), false, true},
      {"conductor_two_sided", "twosided", Bsdf(mirror, true), true, true},
  };
}

Vec3 mirrored_side(Vec3 w) { return {w.x, w.y, -w.z}; }

/// Outgoing directions: near normal, oblique in several azimuths, grazing, and from below.
std::vector<Vec3> outgoing_directions() {
  std::vector<Vec3> directions;
  for (const Vec3 w : {Vec3{0.01f, 0, 1}, Vec3{0.5f, 0.2f, 0.8f}, Vec3{-1, 0.5f, 0.5f}, Vec3{0, -1, 0.1f}}) {
    directions.push_back(normalize(w));
    directions.push_back(mirrored_side(normalize(w)));
  }
  return directions;
}

std::vector<LobeSelection> selections() {
  const LobeSelection all;
  return {all, all.only_connectable(), all.only_other()};
}

bool reflects_from(const BsdfCase& c, Vec3 wo) { return wo.z > 0 || c.both_sides; }

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
  const Bsdf& bsdf = GetParam().bsdf;
  const auto directions = outgoing_directions();
  std::uint64_t seed = 1;
  for (const Vec3 wo : directions)
    for (const LobeSelection& lobes : selections()) {
      const auto sample = [&](TestRandom& random) -> std::optional<Vec3> {
        const float u_lobe = random.get1();
        const auto drawn = bsdf.sample(wo, u_lobe, random.get2(), lobes);
        return drawn && !drawn->delta ? std::optional(drawn->wi) : std::nullopt;
      };
      const auto pdf = [&](Vec3 wi) { return bsdf.pdf_solid_angle(wo, wi, lobes); };
      const ChiSquare result = chi_square_directions(sample, pdf, {.samples = 50'000, .seed = seed++});
      EXPECT_GT(result.p_value, sidak(1e-3, directions.size() * selections().size())) << "wo.z = " << wo.z;
    }
}

TEST_P(EveryBsdf, DensityIntegratesToOneAtMost) {
  const BsdfCase& c = GetParam();
  const Bsdf& bsdf = c.bsdf;
  for (const Vec3 wo : outgoing_directions()) {
    const double total = integrate_over_sphere([&](Vec3 wi) { return bsdf.pdf_solid_angle(wo, wi, LobeSelection()); });
    EXPECT_LE(total, 1 + 1e-4);
    const bool diffuse = bsdf.has(LobeSelection().only_connectable()) && !bsdf.has(LobeSelection().only_other());
    if (diffuse && reflects_from(c, wo)) {
      EXPECT_NEAR(total, 1, 1e-4);
    }
  }
}

TEST_P(EveryBsdf, SampleAgreesWithEvalAndDensity) {
  const Bsdf& bsdf = GetParam().bsdf;
  TestRandom random(2);
  for (const Vec3 wo : outgoing_directions())
    for (const LobeSelection& lobes : selections())
      for (int i = 0; i < 1000; ++i) {
        const float u_lobe = random.get1();
        const auto sample = bsdf.sample(wo, u_lobe, random.get2(), lobes);
        if (!sample) continue;
        ASSERT_TRUE(reflects_from(GetParam(), wo));
        ASSERT_NEAR(length(sample->wi), 1, 1e-5f);
        ASSERT_GT(sample->pdf_solid_angle, 0);
        if (sample->delta) {
          ASSERT_EQ(bsdf.eval(wo, sample->wi, lobes), Rgb());
          ASSERT_EQ(bsdf.pdf_solid_angle(wo, sample->wi, lobes), 0);
          continue;
        }
        const float pdf = bsdf.pdf_solid_angle(wo, sample->wi, lobes);
        const Rgb weight = bsdf.eval(wo, sample->wi, lobes) * std::abs(sample->wi.z) / pdf;
        ASSERT_NEAR(sample->pdf_solid_angle, pdf, 1e-4f * pdf);
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(sample->weight[channel], weight[channel], 1e-4f * weight[channel]);
      }
}

TEST_P(EveryBsdf, IsReciprocal) {
  TestRandom random(3);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3 wo = random.direction(), wi = random.direction();
    const Rgb there = GetParam().bsdf.eval(wo, wi, LobeSelection()),
              back = GetParam().bsdf.eval(wi, wo, LobeSelection());
    for (int channel = 0; channel < 3; ++channel) ASSERT_NEAR(there[channel], back[channel], 1e-5f * there[channel]);
  }
}

TEST_P(EveryBsdf, KeepsItsEnergy) {
  const BsdfCase& c = GetParam();
  const Bsdf& bsdf = c.bsdf;
  TestRandom random(4);
  for (const Vec3 wo : outgoing_directions()) {
    Moments reflected;
    for (int i = 0; i < 2000; ++i) {
      const float u_lobe = random.get1();
      const auto sample = bsdf.sample(wo, u_lobe, random.get2(), LobeSelection());
      reflected.add(sample ? max_channel(sample->weight) : 0);
    }
    const float energy = bsdf.energy(wo, LobeSelection());
    EXPECT_LE(energy, 1);
    if (!reflects_from(c, wo)) {
      EXPECT_EQ(energy, 0);
      EXPECT_EQ(reflected.mean(), 0);
    } else if (c.white) {
      EXPECT_EQ(energy, 1);
      EXPECT_EQ(reflected.mean(), 1);
    } else {
      EXPECT_GT(energy, 0);
      EXPECT_LT(reflected.mean(), 1);
    }
  }
}

// The connectable and the other lobes together are the BSDF, whatever the threshold, and each lobe is in one of them.
TEST_P(EveryBsdf, LobeSelectionSplitsItExactly) {
  const Bsdf& bsdf = GetParam().bsdf;
  TestRandom random(5);
  for (const float threshold : {1e-6f, 0.05f, 0.1f, 0.5f, 1e6f}) {
    LobeSelection all;
    all.connectable_roughness = threshold;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = random.direction(), wi = random.direction();
      const Rgb whole = bsdf.eval(wo, wi, all);
      const Rgb sum = bsdf.eval(wo, wi, all.only_connectable()) + bsdf.eval(wo, wi, all.only_other());
      for (int channel = 0; channel < 3; ++channel) ASSERT_NEAR(sum[channel], whole[channel], 1e-6f * whole[channel]);
    }
    EXPECT_EQ(bsdf.has(all), bsdf.has(all.only_connectable()) || bsdf.has(all.only_other()));
    for (const LobeSelection& lobes : {all.only_connectable(), all.only_other()})
      for (const Vec3 wo : outgoing_directions()) {
        EXPECT_EQ(bsdf.has(lobes) && reflects_from(GetParam(), wo), bsdf.energy(wo, lobes) > 0);
        EXPECT_EQ(bsdf.energy(wo, lobes) > 0, bsdf.sample(wo, 0.5f, {0.3f, 0.6f}, lobes).has_value());
      }
  }
}

TEST_P(EveryBsdf, ConnectableAlbedoBoundsTheConnectableLobes) {
  const Bsdf& bsdf = GetParam().bsdf;
  const LobeSelection connectable = LobeSelection().only_connectable();
  TestRandom random(6);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3 wo = random.direction(), wi = random.direction();
    ASSERT_LE(k_pi * max_channel(bsdf.eval(wo, wi, connectable)), bsdf.max_connectable_albedo(connectable) * 1.00001f);
  }
  EXPECT_EQ(bsdf.max_connectable_albedo(LobeSelection().only_other()), 0);
}

TEST_P(EveryBsdf, IsTheSameOnBothSidesOrBlackOnOne) {
  const BsdfCase& c = GetParam();
  const Bsdf& bsdf = c.bsdf;
  TestRandom random(7);
  for (int i = 0; i < 2000; ++i) {
    Vec3 wo = random.direction();
    wo.z = std::abs(wo.z);
    const Vec3 wi = random.direction();
    const Vec3 wo_below = mirrored_side(wo), wi_below = mirrored_side(wi);
    const Rgb above = bsdf.eval(wo, wi, LobeSelection()), below = bsdf.eval(wo_below, wi_below, LobeSelection());
    ASSERT_EQ(below, c.both_sides ? above : Rgb());
    ASSERT_EQ(bsdf.pdf_solid_angle(wo_below, wi_below, LobeSelection()),
              c.both_sides ? bsdf.pdf_solid_angle(wo, wi, LobeSelection()) : 0);
    ASSERT_EQ(bsdf.eval(wo, mirrored_side(wo), LobeSelection()), Rgb()) << "these BSDFs only reflect";
    const float u_lobe = random.get1();
    const Vec2 u = random.get2();
    const auto sample = bsdf.sample(wo, u_lobe, u, LobeSelection());
    const auto sample_below = bsdf.sample(wo_below, u_lobe, u, LobeSelection());
    ASSERT_TRUE(sample);
    ASSERT_EQ(sample_below.has_value(), c.both_sides);
    if (sample_below) {
      ASSERT_EQ(sample_below->wi, mirrored_side(sample->wi));
      ASSERT_EQ(sample_below->weight, sample->weight);
    }
  }
}

}  // namespace
}  // namespace gradslc
