#include "vpl/connection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "core/frame.h"
#include "support/random.h"
#include "vpl/density.h"

namespace gradslc {
namespace {

Vpl vpl_at(Point3 position, Normal3 normal, Rgb flux, float albedo) {
  Vpl vpl;
  vpl.position = position;
  vpl.flux = flux * albedo;
  vpl.max_pi_f = albedo;
  vpl.geometric_normal = vpl.shading_normal = OctahedralNormal(as_vec(normal));
  vpl.vertex = 1;
  return vpl;
}

ShadedPoint floor_point(float albedo) {
  ShadedPoint x;
  x.frame = frame_from_normal({0, 0, 1});
  x.bsdf.add(Lambert{Rgb(albedo)});
  x.wo = normalize(Vec3{0.3f, 0.1f, 1});
  return x;
}

/// With Lambertian VPLs.
Rgb contribution(const ShadedPoint& x, const Vpl& y, float bound) {
  return unshadowed_contribution({x, LobeSelection()}, {{}, {}}, y, bound);
}

TEST(Connection, MatchesTheFormulaByHand) {
  const ShadedPoint x = floor_point(0.5f);
  // Straight above at distance 2, facing down: f_x G f_y flux = 0.5/pi * 1/4 * 0.8/pi * 3.
  const Vpl y = vpl_at({0, 0, 2}, {0, 0, -1}, Rgb(3), 0.8f);
  EXPECT_NEAR(contribution(x, y, k_infinity).r, 0.5f / k_pi * 0.25f * 0.8f / k_pi * 3, 1e-6f);
  // Bounded: K = 0.5 * 0.8 / 4 = 0.1; b = 0.02 leaves a fifth.
  EXPECT_NEAR(contribution(x, y, 0.02f).r, 0.2f * 0.5f / k_pi * 0.25f * 0.8f / k_pi * 3, 1e-6f);
}

TEST(Connection, IsBlackBehindEitherSurfaceAndAtDistanceZero) {
  const ShadedPoint x = floor_point(0.5f);
  EXPECT_TRUE(is_black(contribution(x, vpl_at({0, 0, -2}, {0, 0, 1}, Rgb(1), 0.5f), 1)));
  EXPECT_TRUE(is_black(contribution(x, vpl_at({0, 0, 2}, {0, 0, 1}, Rgb(1), 0.5f), 1)));
  EXPECT_TRUE(is_black(contribution(x, vpl_at({0, 0, 0}, {0, 0, -1}, Rgb(1), 0.5f), 1)));
}

TEST(Bounding, WeightsAddUpToOne) {
  for (const float bound : {1e-3f, 0.7f, 40.0f, k_infinity})
    for (const float strength : {0.0f, 1e-4f, 0.7f, 3.0f, 1e6f})
      EXPECT_FLOAT_EQ(bounded_weight(strength, bound) + compensation_weight(strength, bound), 1)
          << strength << " " << bound;
}

TEST(Bounding, ContributionNeverExceedsFluxTimesBound) {
  TestRandom random(3);
  for (int i = 0; i < 100000; ++i) {
    const ShadedPoint x = floor_point(random.get1());
    const Vec3 p = random.direction() * random.get1();
    const Vpl y = vpl_at({p.x, p.y, p.z}, as_normal(random.direction()), Rgb(1), 0.05f + 0.95f * random.get1());
    const float bound = std::exp(10 * random.get1() - 5);
    EXPECT_LE(contribution(x, y, bound).r, 1.0001f * bound / (k_pi * k_pi));
  }
}

TEST(Bounding, NothingBeyondTheReachIsCompensated) {
  TestRandom random(4);
  for (int i = 0; i < 10000; ++i) {
    const float pi_f_x = random.get1(), cos_x = random.get1(), albedo = random.get1(), bound = 0.01f + random.get1();
    const float beyond = 1.0001f * compensation_reach(pi_f_x, cos_x, albedo, bound);
    const float strength = connection_strength(pi_f_x, albedo, cos_x, 1, beyond * beyond);
    EXPECT_EQ(compensation_weight(strength, bound), 0);
  }
}

// Points uniform on a square of side 3: 1/A = 1/9. The border lowers the density of a few.
TEST(Density, OfAUniformSquare) {
  TestRandom random(5);
  std::vector<Vpl> vpls;
  for (int i = 0; i < 20000; ++i)
    vpls.push_back(vpl_at({3 * random.get1(), 3 * random.get1(), 0}, {0, 0, 1}, Rgb(1), 0.5f));
  EXPECT_NEAR(inverse_covered_area(vpls), 1.0 / 9, 0.08 / 9);
  EXPECT_NEAR(automatic_bound(vpls, 4), k_pi * 20000 / 4 / 9, 0.08 * k_pi * 20000 / 4 / 9);
}

TEST(Density, DegenerateSetsHaveNone) {
  EXPECT_EQ(inverse_covered_area({}), 0);
  const std::vector<Vpl> same(100, vpl_at({1, 2, 3}, {0, 0, 1}, Rgb(1), 0.5f));
  EXPECT_EQ(inverse_covered_area(same), 0);
  EXPECT_EQ(inverse_covered_area(std::span(same).first(2)), 0);
}

TEST(Density, ScalesWithTheScene) {
  TestRandom random(6);
  std::vector<Vpl> vpls, kilometres;
  for (int i = 0; i < 3000; ++i) {
    const Point3 p{random.get1(), random.get1(), random.get1()};
    vpls.push_back(vpl_at(p, {0, 0, 1}, Rgb(1), 0.5f));
    kilometres.push_back(vpl_at({1024 * p.x, 1024 * p.y, 1024 * p.z}, {0, 0, 1}, Rgb(1), 0.5f));
  }
  EXPECT_DOUBLE_EQ(inverse_covered_area(vpls), inverse_covered_area(kilometres) * 1024 * 1024);
}

}  // namespace
}  // namespace gradslc
