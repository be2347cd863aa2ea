#include "reconstruction/screened_poisson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "unit/reconstruction/dense_solver.h"
#include "unit/reconstruction/random_problem.h"

namespace gradslc {
namespace {

constexpr SolverOptions k_precise{.relative_residual = 1e-12};
constexpr Resolution k_sizes[] = {{1, 1}, {1, 2}, {2, 1}, {1, 13}, {13, 1}, {2, 2}, {5, 7}, {11, 3}, {7, 7}};

void expect_dense_solution(const RandomProblem& random) {
  const ReconstructionResult result = solve(random.problem(), k_precise);
  EXPECT_TRUE(result.statistics.converged);
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<double> expected = DenseSystem(random.problem(), channel).solve();
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_NEAR(static_cast<double>(result.image[i][channel]), expected[i], 1e-6 * (1 + std::abs(expected[i])))
          << random.primal.width() << "x" << random.primal.height() << ", pixel " << i << ", channel " << channel;
  }
}

TEST(ScreenedPoisson, MatchesADenseSolution) {
  for (const Resolution size : k_sizes) expect_dense_solution(RandomProblem(size, 1));
}

// Solved by alternating directions: alike, and alike but for a factor of 3.
TEST(ScreenedPoisson, MatchesADenseSolutionWhereWeightsAreNearlyAlike) {
  for (const Resolution size : k_sizes)
    for (const float spread : {0.0f, 2.0f}) {
      RandomProblem random(size, 9);
      const auto draw_in = [&](float least, Image<float>& weights) {
        for (float& weight : weights) weight = least * (1 + spread * weight / (weight + 1));
      };
      draw_in(0.04f, random.weights.primal), draw_in(1, random.weights.dx), draw_in(0.7f, random.weights.dy);
      expect_dense_solution(random);
    }
}

TEST(ScreenedPoisson, MatchesADenseSolutionWherePrimalWeightsAreZero) {
  for (const Resolution size : k_sizes) {
    RandomProblem random(size, 2, 0.04f, 0.7f);
    random.weights.primal[random.weights.primal.size() / 2] = 0.01f;  // at least one, so that there is one solution
    expect_dense_solution(random);
  }
}

TEST(ScreenedPoisson, MatchesADenseSolutionWhereGradientWeightsAreZero) {
  for (const Resolution size : k_sizes) expect_dense_solution(RandomProblem(size, 3, 1.0f, 0, 0.5f));
}

TEST(ScreenedPoisson, UnusedGradientsDoNotCount) {
  RandomProblem random({5, 4}, 4);
  const RgbImage image = solve(random.problem(), k_precise).image;
  for (int y = 0; y < 4; ++y) random.dx(4, y) = Rgb(1e6f), random.weights.dx(4, y) = 1e6f;
  for (int x = 0; x < 5; ++x) random.dy(x, 3) = Rgb(1e6f), random.weights.dy(x, 3) = 1e6f;
  EXPECT_EQ(solve(random.problem(), k_precise).image, image);
}

/// The largest of the channels' residuals of an image, from the dense matrix.
double dense_residual(const RandomProblem& random, const RgbImage& image) {
  double largest = 0;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<double> values;
    for (const Rgb& pixel : image) values.push_back(static_cast<double>(pixel[channel]));
    largest = std::max(largest, DenseSystem(random.problem(), channel).relative_residual(values));
  }
  return largest;
}

TEST(ScreenedPoisson, ReportsTheTrueResidual) {
  for (const double asked : {0.1, 1e-2, 1e-3, 1e-4}) {
    const RandomProblem random({12, 9}, 5, 0.01f);
    const ReconstructionResult result = solve(random.problem(), {.relative_residual = asked});
    EXPECT_TRUE(result.statistics.converged);
    EXPECT_LE(result.statistics.relative_residual, asked);
    EXPECT_NEAR(result.statistics.relative_residual, dense_residual(random, result.image), 0.02 * asked);
  }
}

TEST(ScreenedPoisson, SaysWhenItHasNotConverged) {
  const RandomProblem random({12, 9}, 5, 0.001f);
  const ReconstructionResult result = solve(random.problem(), {.relative_residual = 1e-5, .max_iterations = 4});
  EXPECT_FALSE(result.statistics.converged);
  EXPECT_EQ(result.statistics.iterations, 4);
  EXPECT_GT(result.statistics.relative_residual, 1e-5);
  EXPECT_NEAR(result.statistics.relative_residual / dense_residual(random, result.image), 1, 1e-4);
}

TEST(ScreenedPoisson, GivesUpOnAResidualBelowRounding) {
  const RandomProblem random({20, 20}, 6);
  const ReconstructionResult result = solve(random.problem(), {.relative_residual = 1e-30});
  EXPECT_FALSE(result.statistics.converged);
  EXPECT_LT(result.statistics.relative_residual, 1e-13);
  EXPECT_LT(result.statistics.iterations, 20000);
}

/// Whole numbers, so that differences are exact.
RgbImage whole_numbers(Resolution resolution) {
  RgbImage image(resolution);
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = {static_cast<float>(i * i % 17), static_cast<float>(i % 5), -static_cast<float>(i % 3)};
  return image;
}

TEST(ScreenedPoisson, ExactPrimalAndGradientsGiveTheExactImage) {
  for (const float primal_scale : {1e-6f, 0.04f, 1e4f}) {
    RandomProblem random({17, 11}, 7, primal_scale, 0, 0.3f);
    random.primal = whole_numbers({17, 11});
    set_differences(random.primal, random.dx, random.dy);
    EXPECT_EQ(solve(random.problem(), k_precise).image, random.primal) << primal_scale;
  }
}

TEST(ScreenedPoisson, OnePixelAndGradientsGiveTheImage) {
  RandomProblem random({17, 11}, 8, 0.04f, 1);
  const RgbImage truth = whole_numbers({17, 11});
  set_differences(truth, random.dx, random.dy);
  random.primal(3, 4) = truth(3, 4);
  random.weights.primal(3, 4) = 0.04f;
  const ReconstructionResult result = solve(random.problem(), k_precise);
  EXPECT_TRUE(result.statistics.converged);
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.image[i][c], truth[i][c], 1e-5f);
}

TEST(ScreenedPoisson, WithoutPrimalWeightsTheImageFollowsTheGradients) {
  RandomProblem random({17, 11}, 9, 0.04f, 1);
  const RgbImage truth = whole_numbers({17, 11});
  set_differences(truth, random.dx, random.dy);
  const ReconstructionResult result = solve(random.problem(), {});
  EXPECT_TRUE(result.statistics.converged);
  const Rgb offset = result.image[0] - truth[0];
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.image[i][c] - truth[i][c], offset[c], 1e-3f);
}

/// The left three columns have no weight at all, nor has the edge to them; the rest is as if they were not there.
TEST(ScreenedPoisson, PixelsWithoutAnyWeightAreZeroAndApart) {
  RandomProblem random({8, 6}, 10);
  RandomProblem rest({5, 6}, 10);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 3; ++x) random.weights.primal(x, y) = random.weights.dx(x, y) = random.weights.dy(x, y) = 0;
    for (int x = 0; x < 5; ++x) {
      rest.primal(x, y) = random.primal(x + 3, y);
      rest.dx(x, y) = random.dx(x + 3, y);
      rest.dy(x, y) = random.dy(x + 3, y);
      rest.weights.primal(x, y) = random.weights.primal(x + 3, y);
      rest.weights.dx(x, y) = random.weights.dx(x + 3, y);
      rest.weights.dy(x, y) = random.weights.dy(x + 3, y);
    }
  }
  const RgbImage image = solve(random.problem(), k_precise).image, alone = solve(rest.problem(), k_precise).image;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 3; ++x) EXPECT_EQ(image(x, y), Rgb(0));
    for (int x = 0; x < 5; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image(x + 3, y)[c], alone(x, y)[c], 1e-6f);
  }
}

TEST(ScreenedPoisson, NoWeightsAtAllGiveBlack) {
  const ReconstructionResult result = solve(RandomProblem({4, 3}, 11, 0, 1, 1).problem(), {});
  for (const Rgb& pixel : result.image) EXPECT_EQ(pixel, Rgb(0));
  EXPECT_TRUE(result.statistics.converged);
}

TEST(ScreenedPoisson, SurvivesWeightsOfAnyScale) {
  for (const float scale : {1e-40f, 1e-30f, 1e30f}) {
    RandomProblem random({9, 8}, 12);
    const RgbImage expected = solve(random.problem(), k_precise).image;
    for (Image<float>* weights : {&random.weights.primal, &random.weights.dx, &random.weights.dy})
      for (float& weight : *weights) weight *= scale;
    const RgbImage image = solve(random.problem(), k_precise).image;
    const float tolerance = scale < 1e-38f ? 1e-2f : 1e-5f;  // denormal weights have few digits
    for (std::size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(image[i].r, expected[i].r, tolerance) << scale;
  }
}

template <class T>
Image<T> transposed(const Image<T>& image) {
  Image<T> result({image.height(), image.width()});
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) result(y, x) = image(x, y);
  return result;
}

TEST(ScreenedPoisson, XAndYAreAlike) {
  const RandomProblem random({13, 7}, 13, 0.04f, 0.3f);
  RandomProblem turned({7, 13}, 13);
  turned.primal = transposed(random.primal);
  turned.dx = transposed(random.dy);
  turned.dy = transposed(random.dx);
  turned.weights = {transposed(random.weights.primal), transposed(random.weights.dy), transposed(random.weights.dx)};
  const RgbImage image = solve(random.problem(), k_precise).image;
  const RgbImage back = transposed(solve(turned.problem(), k_precise).image);
  for (std::size_t i = 0; i < image.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image[i][c], back[i][c], 1e-6f);
}

TEST(ScreenedPoisson, SameBitsForAnyNumberOfThreads) {
  const RandomProblem random({400, 211}, 14);  // several chunks of rows and of pixels
  constexpr SolverOptions k_options{.max_iterations = 8};
  set_thread_count(1);
  const ReconstructionResult expected = solve(random.problem(), k_options);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const ReconstructionResult result = solve(random.problem(), k_options);
    EXPECT_EQ(result.image, expected.image);
    EXPECT_EQ(result.statistics.iterations, expected.statistics.iterations);
    EXPECT_EQ(result.statistics.relative_residual, expected.statistics.relative_residual);
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace gradslc
