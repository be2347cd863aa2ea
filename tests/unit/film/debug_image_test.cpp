#include "film/debug_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gradslc {
namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

TEST(Largest, KeepsTheEarliestOfEquals) {
  Largest largest;
  largest.raise({0, 4, Part::direct});
  EXPECT_EQ(largest, Largest());
  largest.raise({2, 9, Part::direct});
  largest.raise({2, 5, Part::vpl});
  largest.raise({2, 7, Part::prefix});
  largest.raise({1, 1, Part::prefix});
  EXPECT_EQ(largest, (Largest{2, 5, Part::vpl}));
}

TEST(Largest, FindsWhatIsNotFinite) {
  Largest largest{1e30f, 0, Part::vpl};
  largest.raise({std::nanf(""), 3, Part::direct});
  EXPECT_EQ(largest, (Largest{k_infinity, 3, Part::direct}));
  largest.raise({k_infinity, 2, std::nullopt});
  EXPECT_EQ(largest, (Largest{k_infinity, 2, std::nullopt}));
}

TEST(DebugImage, AddsUpCostsAndFindsTheLargestContribution) {
  DebugImage image({3, 2});
  EXPECT_EQ(pixel_of_largest_contribution(image), std::nullopt);
  image.add({1, 1}, {.pass = 6, .cut_size = 3, .rays = 7, .contribution = {2, 6, Part::vpl}, .value = Rgb(5)});
  image.add({1, 1}, {.pass = 8, .cut_size = 4, .rays = 1, .contribution = {3, 8, Part::direct}, .value = Rgb(3)});
  image.add({2, 1}, {.pass = 1, .contribution = {3, 1, Part::prefix}});
  EXPECT_EQ(image[Pixel(1, 1)].cut_size, 7);
  EXPECT_EQ(image[Pixel(1, 1)].rays, 8);
  EXPECT_EQ(image[Pixel(1, 1)].samples, 2u);
  EXPECT_EQ(image[Pixel(1, 1)].contribution, (Largest{3, 8, Part::direct}));
  EXPECT_EQ(image[Pixel(1, 1)].sample.pass, 6);
  EXPECT_FLOAT_EQ(image[Pixel(1, 1)].sample.luminance, 5);
  EXPECT_EQ(pixel_of_largest_contribution(image), (Pixel{1, 1}));
}

}  // namespace
}  // namespace gradslc
