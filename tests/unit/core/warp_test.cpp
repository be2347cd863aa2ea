#include "core/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/direction_test.h"
#include "support/random.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

constexpr int k_samples = 500'000;
constexpr float k_corners[] = {0.0f, 0.25f, 0.5f, 0.75f, k_one_minus_epsilon};

TEST(CosSinOfOctant, AreThoseOfTheLibrary) {
  for (int i = -1000; i <= 1000; ++i) {
    const double t = i / 1000.0;
    const Vec2 p = cos_sin_of_octant(static_cast<float>(t));
    ASSERT_NEAR(p.x, std::cos(t * std::numbers::pi / 4), 2e-7) << t;
    ASSERT_NEAR(p.y, std::sin(t * std::numbers::pi / 4), 2e-7) << t;
  }
}

// The tests of uniformity below have a false-alarm rate of 0.1 % each.
TEST(SquareToDisk, IsUniform) {
  constexpr int rings = 8, sectors = 24;  // rings of equal area
  std::vector<double> counts(rings * sectors);
  TestRandom random(1);
  for (int i = 0; i < k_samples; ++i) {
    const Vec2 d = square_to_disk(random.get2());
    const float squared = d.x * d.x + d.y * d.y;
    ASSERT_LE(squared, 1 + 1e-6f);
    const double turn = std::atan2(d.y, d.x) / (2.0 * k_pi) + 0.5;
    const int ring = std::min(static_cast<int>(squared * rings), rings - 1);
    const int sector = std::min(static_cast<int>(turn * sectors), sectors - 1);
    counts[static_cast<std::size_t>(ring * sectors + sector)] += 1;
  }
  EXPECT_GT(chi_square_uniform(counts).p_value, 1e-3);
}

TEST(SquareToDisk, KeepsNeighboursTogether) {
  constexpr int side = 200;
  const auto at = [](int x, int y) {
    return square_to_disk({(static_cast<float>(x) + 0.5f) / side, (static_cast<float>(y) + 0.5f) / side});
  };
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x)
      for (const Vec2 neighbour : {at(x + 1, y), at(x, y + 1)}) {
        const Vec2 step = neighbour - at(x, y);
        ASSERT_LT(std::hypot(step.x, step.y), 4.0f / side);
      }
}

TEST(SquareToCosineHemisphere, FollowsItsDensity) {
  const auto sample = [](TestRandom& random) -> std::optional<Vec3> {
    return square_to_cosine_hemisphere(random.get2());
  };
  EXPECT_GT(chi_square_directions(sample, [](Vec3 w) { return cosine_hemisphere_pdf_solid_angle(w.z); }).p_value, 1e-3);
}

TEST(SquareToSphere, FollowsItsDensity) {
  const auto sample = [](TestRandom& random) -> std::optional<Vec3> { return square_to_sphere(random.get2()); };
  EXPECT_GT(chi_square_directions(sample, [](Vec3) { return k_inv_pi / 4; }).p_value, 1e-3);
}

TEST(SquareToTriangle, IsUniform) {
  constexpr int side = 16;  // cells of equal area: halves of a grid's squares
  std::vector<double> counts(side * side);
  TestRandom random(2);
  for (int i = 0; i < k_samples; ++i) {
    const Vec2 b = square_to_triangle(random.get2());
    ASSERT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1) << b.x << " " << b.y;
    const int x = std::min(static_cast<int>(b.x * side), side - 1),
              y = std::min(static_cast<int>(b.y * side), side - 1);
    const bool upper = b.x * side - static_cast<float>(x) + b.y * side - static_cast<float>(y) > 1;
    // An upper half at (x, y) takes the place of the lower half at (side-1-x, side-1-y), which lies outside.
    counts[static_cast<std::size_t>(upper ? (side - 1 - y) * side + side - 1 - x : y * side + x)] += 1;
  }
  EXPECT_GT(chi_square_uniform(counts).p_value, 1e-3);
}

TEST(Warps, StayInTheirDomainsAtTheSquaresCorners) {
  for (const float x : k_corners)
    for (const float y : k_corners) {
      const Vec2 disk = square_to_disk({x, y});
      EXPECT_LE(std::hypot(disk.x, disk.y), 1 + 1e-6f);
      EXPECT_NEAR(length(square_to_cosine_hemisphere({x, y})), 1, 1e-6f);
      EXPECT_GE(square_to_cosine_hemisphere({x, y}).z, 0);
      EXPECT_NEAR(length(square_to_sphere({x, y})), 1, 1e-6f);
      const Vec2 b = square_to_triangle({x, y});
      EXPECT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1);
    }
}

}  // namespace
}  // namespace gradslc
