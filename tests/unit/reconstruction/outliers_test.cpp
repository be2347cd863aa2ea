#include "reconstruction/outliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/reconstruction/method_test_support.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{60, 44};
constexpr double k_threshold = 12;

auto gaussian(double sigma) {
  return [sigma](std::size_t, std::mt19937_64& random) { return std::normal_distribution<double>(0, sigma)(random); };
}

ReconstructionInput noisy_input(unsigned seed) {
  std::mt19937_64 random(seed);
  return sample_input(test_truth(k_resolution), 6, gaussian(0.1), gaussian(0.05), random);
}

/// Differences of halves are normal with this threshold beyond 7 of their standard deviations: no false alarm in
/// 60 x 44 x 9 values (p < 1e-7).
TEST(Outliers, NoiseAndEdgesStay) {
  const ReconstructionInput input = noisy_input(1);
  const CleanedInput cleaned = without_outliers(input, k_threshold);
  EXPECT_EQ(cleaned.removed, 0u);
  EXPECT_EQ(cleaned.input.combined.primal, input.combined.primal);
}

TEST(Outliers, TheHalfThatHasOneTakesTheOthersValue) {
  ReconstructionInput input = noisy_input(2);
  input.halves[1].primal(20, 10) += Rgb(5);
  input.halves[0].dx(30, 5) += Rgb(0, -5, 0);
  input.halves[1].dy(7, 40) += Rgb(0, 0, 5);
  const CleanedInput cleaned = without_outliers(input, k_threshold);
  EXPECT_EQ(cleaned.removed, 3u);
  const ReconstructionInput& found = cleaned.input;
  EXPECT_EQ(found.halves[1].primal(20, 10), input.halves[0].primal(20, 10));
  EXPECT_EQ(found.halves[1].primal_count(20, 10), 0);
  EXPECT_TRUE(std::isinf(found.halves[1].primal_variance(20, 10).r));
  EXPECT_EQ(found.combined.primal(20, 10), input.halves[0].primal(20, 10));
  EXPECT_EQ(found.combined.primal_count(20, 10), 6);
  EXPECT_EQ(found.combined.dx(30, 5), input.halves[1].dx(30, 5));
  EXPECT_EQ(found.combined.dy(7, 40), input.halves[0].dy(7, 40));
}

TEST(Outliers, WithoutASecondHalfNothingIsKnown) {
  ReconstructionInput input = noisy_input(3);
  input.halves[0].primal(20, 10) += Rgb(50);
  for (float& count : input.halves[1].primal_count) count = 0;
  EXPECT_EQ(without_outliers(input, k_threshold).removed, 0u);
}

TEST(Outliers, LightThatFewPixelsHaveMetStays) {
  ReconstructionInput input = noisy_input(4);
  for_all_buffers(input, [](ReconstructionBuffers& buffers) {
    for (Rgb& value : buffers.primal) value = Rgb(0);
  });
  for (int i = 0; i < 40; ++i) input.halves[i % 2].primal(i, i) = Rgb(1);
  EXPECT_EQ(without_outliers(input, k_threshold).removed, 0u);
}

double squared_error(const RgbImage& image, const RgbImage& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += std::pow(static_cast<double>(image[i][c]) - static_cast<double>(truth[i][c]), 2);
  return sum;
}

/// A sample a thousand times too bright: in 1 of 10,000 samples, here in 3 values of each term of each half.
void add_fireflies(ReconstructionInput& input, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pixel(0, k_resolution.pixels() - 1);
  constexpr int k_fireflies = 3;
  for (ReconstructionBuffers& half : input.halves)
    for (const auto& [mean, variance] :
         {std::pair{&half.primal, &half.primal_variance}, std::pair{&half.dx, &half.dx_variance},
          std::pair{&half.dy, &half.dy_variance}})
      for (int i = 0; i < k_fireflies; ++i) {
        const std::size_t at = pixel(random);
        const Rgb extra = 1000.0f / 6 * (*mean)[at];  // of the mean of 6 samples
        (*mean)[at] += extra;
        (*variance)[at] += extra * extra;
      }
  input.combined = combine(input.halves[0], input.halves[1]);
}

TEST(Outliers, RobustReconstructionsShrugOffFireflies) {
  const RgbImage truth = test_truth(k_resolution);
  struct Case {
    const char* name;
    std::map<std::string, double> parameters;
    double most = 1.1;  ///< growth of the squared error
  };
  const Case robust[] = {{"none", {{"remove", 1}}},        {"l2", {{"remove", 1}}},      {"l1", {}},
                         {"weighted", {{"remove", 1}}},    {"feature", {{"remove", 1}}}, {"denoise", {{"remove", 1}}},
                         {"weighted", {{"cross", 0}}, 2.5}};  // its neighbours lose weight, too
  for (const unsigned seed : {11u, 12u, 13u}) {
    const ReconstructionInput clean = noisy_input(seed);
    ReconstructionInput struck = clean;
    add_fireflies(struck, seed);
    const auto growth = [&](const Reconstruction& method) {
      return squared_error(method.reconstruct(struck).image, truth) /
             squared_error(method.reconstruct(clean).image, truth);
    };
    for (const Case& of : robust)
      EXPECT_LE(growth(*make_reconstruction(of.name, of.parameters)), of.most) << of.name << ", seed " << seed;
    EXPECT_GE(growth(*make_reconstruction("l2")), 100);
  }
}

TEST(Outliers, AreCounted) {
  ReconstructionInput input = noisy_input(5);
  input.halves[1].primal(20, 10) += Rgb(5);
  EXPECT_EQ(make_reconstruction("l2", {{"remove", 1}})->reconstruct(input).statistics.outliers, 1u);
  EXPECT_EQ(make_reconstruction("l2")->reconstruct(input).statistics.outliers, 0u);
}

}  // namespace
}  // namespace gradslc
