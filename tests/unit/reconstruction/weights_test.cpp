#include "reconstruction/weights.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/reconstruction/method_test_support.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{9, 8};
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// `count` samples everywhere, with means of the given variances.
ReconstructionBuffers uniform_buffers(float count, float primal, float dx, float dy) {
  ReconstructionBuffers buffers = empty_buffers(k_resolution);
  for (std::size_t i = 0; i < k_resolution.pixels(); ++i) {
    buffers.primal_count[i] = buffers.dx_count[i] = buffers.dy_count[i] = count;
    buffers.primal_variance[i] = Rgb(primal);
    buffers.dx_variance[i] = Rgb(dx);
    buffers.dy_variance[i] = Rgb(dy);
  }
  return buffers;
}

void expect_equal(const PoissonWeights& a, const PoissonWeights& b) {
  EXPECT_EQ(a.primal, b.primal);
  EXPECT_EQ(a.dx, b.dx);
  EXPECT_EQ(a.dy, b.dy);
}

TEST(CountWeights, AreUniformForConstantCounts) {
  const PoissonWeights weights = count_weights(uniform_buffers(64, 1, 1, 1), 0.5);
  EXPECT_EQ(weights.primal, Image<float>(k_resolution, 0.25f));
  EXPECT_EQ(weights.dx, Image<float>(k_resolution, 1));
  EXPECT_EQ(weights.dy, Image<float>(k_resolution, 1));
}

TEST(CountWeights, AreProportionalToCounts) {
  ReconstructionBuffers buffers = uniform_buffers(8, 1, 1, 1);
  buffers.primal_count(1, 2) = 16;
  buffers.dx_count(3, 2) = 4;
  buffers.dy_count(3, 2) = 0;
  const PoissonWeights weights = count_weights(buffers, 1);
  EXPECT_EQ(weights.primal(1, 2), 1);
  EXPECT_EQ(weights.primal(0, 0), 0.5f);
  EXPECT_EQ(weights.dx(3, 2), 0.25f);
  EXPECT_EQ(weights.dy(3, 2), 0);
}

TEST(VarianceWeights, AreInverseVariancesTimesLambda) {
  const ReconstructionBuffers buffers = uniform_buffers(10, 4, 2, 1);
  const PoissonWeights weights = variance_weights(buffers, buffers, {.lambda = 0.5});
  EXPECT_FLOAT_EQ(weights.dx(2, 2) / weights.primal(2, 2), 4);  // (1/2) / (0.5 / 4)
  EXPECT_FLOAT_EQ(weights.dy(2, 2) / weights.primal(2, 2), 8);
  EXPECT_EQ(weights.primal, Image<float>(k_resolution, weights.primal(0, 0)));
}

TEST(VarianceWeights, AreAveragedOverChannels) {
  ReconstructionBuffers buffers = uniform_buffers(10, 1, 1, 1);
  for (Rgb& variance : buffers.dx_variance) variance = {3, 4, 5};
  const PoissonWeights weights = variance_weights(buffers, buffers, {});
  EXPECT_FLOAT_EQ(weights.primal(0, 0) / weights.dx(0, 0), 4);
}

/// One pixel's variance differs: its weight, and how far it reaches, shows the box and the floor.
TEST(VarianceWeights, AreSupportedByHalfTheMeanOfBoxes) {
  ReconstructionBuffers buffers = uniform_buffers(1, 1, 1, 1);
  buffers.dx_variance(4, 4) = Rgb(50);
  const float reference = variance_weights(buffers, buffers, {}).dy(0, 0) * 1.001f;  // variance 1 and floor 0.001
  const auto dx_variance = [&](int radius, int x, int y) {
    return reference / variance_weights(buffers, buffers, {.radius = radius}).dx(x, y) - 0.001f * (64 + 49) / 64;
  };
  EXPECT_NEAR(dx_variance(1, 4, 4), 50, 0.1f) << "its own is more than half of (8 + 50) / 9";
  EXPECT_NEAR(dx_variance(1, 3, 5), (8 + 50) / 18.0f, 1e-4f);
  EXPECT_NEAR(dx_variance(1, 2, 5), 1, 1e-4f) << "its own is more than half of 1";
  EXPECT_NEAR(dx_variance(2, 2, 5), (24 + 50) / 50.0f, 1e-4f);
  EXPECT_NEAR(dx_variance(0, 4, 4), 50, 0.1f);
  EXPECT_NEAR(dx_variance(0, 3, 4), 1, 1e-4f);
}

TEST(VarianceWeights, BoxesAtTheBorderHaveOnlyTheImagesPixels) {
  ReconstructionBuffers buffers = uniform_buffers(1, 1, 1, 1);
  buffers.primal_variance(0, 0) = Rgb(9);
  const PoissonWeights weights = variance_weights(buffers, buffers, {});
  EXPECT_NEAR(weights.dy(5, 5) / weights.primal(1, 0), (5 + 9) / 12.0f, 0.01f);
}

TEST(VarianceWeights, UnknownVariancesTakeThoseOfTheBoxOrTheMean) {
  ReconstructionBuffers buffers = uniform_buffers(2, 1, 1, 1);
  buffers.dx_variance(4, 4) = Rgb(k_infinity);
  buffers.dx_count(4, 4) = 1;
  const PoissonWeights boxed = variance_weights(buffers, buffers, {});
  EXPECT_FLOAT_EQ(boxed.dx(4, 4), boxed.dx(0, 0) / 2) << "the box's variance of one sample, half the samples";
  const PoissonWeights rough = variance_weights(buffers, buffers, {.radius = 0});
  EXPECT_FLOAT_EQ(rough.dx(4, 4), rough.dx(0, 0) / 2) << "the image's";
}

TEST(VarianceWeights, ComeFromTheSourceAndCountsFromTheWeighted) {
  const ReconstructionBuffers source = uniform_buffers(10, 4, 2, 1);
  ReconstructionBuffers weighted = uniform_buffers(10, 99, k_infinity, 5);
  weighted.dx_count(3, 3) = 20;
  weighted.primal_count(3, 3) = 0;
  const PoissonWeights weights = variance_weights(weighted, source, {});
  EXPECT_FLOAT_EQ(weights.dy(0, 0) / weights.primal(0, 0), 4);
  EXPECT_FLOAT_EQ(weights.dx(3, 3) / weights.dx(0, 0), 2);
  EXPECT_EQ(weights.primal(3, 3), 0);
}

TEST(VarianceWeights, FallBackToCountsWhereNothingIsKnown) {
  ReconstructionBuffers buffers = uniform_buffers(1, 1, 1, 1);
  buffers.dx_count(2, 2) = 3;
  for (float unknown : {k_infinity, 0.0f}) {  // fewer than two sets; no noise at all
    for (std::size_t i = 0; i < k_resolution.pixels(); ++i)
      buffers.primal_variance[i] = buffers.dx_variance[i] = buffers.dy_variance[i] = Rgb(unknown);
    expect_equal(variance_weights(buffers, buffers, {}), count_weights(buffers, k_default_alpha));
  }
  buffers = uniform_buffers(1, 1, 1, k_infinity);
  expect_equal(variance_weights(buffers, buffers, {}), count_weights(buffers, k_default_alpha));
}

TEST(VarianceWeights, AreFiniteForATermWithoutNoise) {
  const ReconstructionBuffers buffers = uniform_buffers(10, 1, 0, 0);
  const PoissonWeights weights = variance_weights(buffers, buffers, {});
  EXPECT_NEAR(weights.dx(0, 0) / weights.primal(0, 0), 1.001e6f, 1e3f);
  EXPECT_EQ(weights.dx(8, 0), 0) << "not used";
}

TEST(VarianceWeights, ImagesOfOneColumnNeedNoDx) {
  ReconstructionBuffers buffers = empty_buffers({1, 5});
  for (std::size_t i = 0; i < 5; ++i) {
    buffers.primal_count[i] = buffers.dy_count[i] = 4;
    buffers.primal_variance[i] = Rgb(2);
    buffers.dy_variance[i] = Rgb(1);
  }
  const PoissonWeights weights = variance_weights(buffers, buffers, {});
  EXPECT_FLOAT_EQ(weights.dy[2] / weights.primal[2], 2);
}

}  // namespace
}  // namespace gradslc
