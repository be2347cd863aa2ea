#include "reconstruction/blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gradslc {
namespace {

constexpr Resolution k_resolution{40, 30};

/// A ramp, so that sizes differ.
RgbImage truth() {
  RgbImage image(k_resolution);
  for (int y = 0; y < k_resolution.height; ++y)
    for (int x = 0; x < k_resolution.width; ++x) image(x, y) = Rgb(1 + 0.1f * static_cast<float>(x));
  return image;
}

/// The image times 1 + noise of this relative deviation.
RgbImage noisy(const RgbImage& image, double sigma, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, sigma);
  RgbImage result = image;
  for (Rgb& value : result) value *= static_cast<float>(1 + normal(random));
  return result;
}

RgbImage scaled(RgbImage image, float scale) {
  for (Rgb& value : image) value *= scale;
  return image;
}

double error(const RgbImage& image) {
  const RgbImage expected = truth();
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    sum += std::pow(static_cast<double>(image[i].g / expected[i].g) - 1, 2);
  return sum / static_cast<double>(image.size());
}

TEST(Blend, GoesAllTheWayWhereTheJudgeConfirmsIt) {
  const RgbImage from = noisy(truth(), 0.1, 1);
  const RgbImage blended = blend(from, truth(), truth(), 7);
  for (std::size_t i = 0; i < blended.size(); ++i) EXPECT_NEAR(blended[i].g, truth()[i].g, 1e-5f);
}

/// A filter that has lost a fifth of the light, against a solution with little noise: next to nothing of it is taken.
TEST(Blend, LeavesWhatTheJudgeContradicts) {
  const RgbImage from = noisy(truth(), 0.01, 1), judge = noisy(truth(), 0.01, 2);
  EXPECT_LT(error(blend(from, scaled(truth(), 0.8f), judge, 7)), 6e-4);
}

/// Noise of 0.1 on the one side and a bias of 0.1 on the other: the best is halfway, with half of either's error. It is
/// found with a judge as noisy as the solution.
TEST(Blend, FindsTheBestBetweenNoiseAndBias) {
  const RgbImage from = noisy(truth(), 0.1, 1), towards = scaled(truth(), 0.9f), judge = noisy(truth(), 0.1, 2);
  const double best = 0.5 * 0.1 * 0.1;
  EXPECT_NEAR(error(blend(from, towards, judge, 7)), best, 0.15 * best);
}

TEST(Blend, WithoutDifferencesNothingHappens) {
  EXPECT_EQ(blend(truth(), truth(), noisy(truth(), 0.1, 1), 7), truth());
  EXPECT_EQ(blend(RgbImage(k_resolution), RgbImage(k_resolution), truth(), 7), RgbImage(k_resolution));
}

}  // namespace
}  // namespace gradslc
