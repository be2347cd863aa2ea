#include "reconstruction/multigrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/reconstruction/random_problem.h"

namespace gradslc {
namespace {

constexpr Resolution k_sizes[] = {{1, 1}, {1, 13}, {13, 1}, {2, 2}, {5, 7}, {31, 8}, {64, 64}, {97, 61}};

std::vector<float> random_field(Resolution size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-1, 1);
  std::vector<float> field(3 * size.pixels());
  for (float& v : field) v = value(random);
  return field;
}

/// Per channel.
std::array<double, 3> dot(const std::vector<float>& a, const std::vector<float>& b) {
  std::array<double, 3> sums = {};
  const std::size_t plane = a.size() / 3;
  for (std::size_t i = 0; i < a.size(); ++i) sums[i / plane] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sums;
}

std::vector<float> precondition(Multigrid& multigrid, Resolution size, const std::vector<float>& field) {
  Field residual(size), result(size), scratch(size);
  std::copy(field.begin(), field.end(), residual.begin());
  multigrid.apply(residual, result, scratch);
  return {result.begin(), result.end()};
}

TEST(Multigrid, IsSymmetricAndPositive) {
  for (const Resolution size : k_sizes)
    for (const float zeros : {0.0f, 0.4f}) {
      const RandomProblem random(size, 1, 0.01f, zeros, zeros);
      Multigrid multigrid(random.weights);
      const std::vector<float> u = random_field(size, 2), v = random_field(size, 3);
      const std::vector<float> mu = precondition(multigrid, size, u), mv = precondition(multigrid, size, v);
      const auto uv = dot(u, mv), vu = dot(v, mu), uu = dot(u, mu), vv = dot(v, mv);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(uv[c], vu[c], 1e-4 * std::sqrt(uu[c] * vv[c]) + 1e-30) << size.width << " x " << size.height;
        EXPECT_GE(uu[c], 0);
      }
    }
}

TEST(Multigrid, ChannelsAreApart) {
  constexpr Resolution k_size{19, 14};
  const RandomProblem random(k_size, 4);
  Multigrid multigrid(random.weights);
  std::vector<float> field(3 * k_size.pixels());
  const std::vector<float> values = random_field(k_size, 5);
  std::copy_n(values.begin(), k_size.pixels(), field.begin() + k_size.pixels());
  const std::vector<float> result = precondition(multigrid, k_size, field);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i] != 0, i / k_size.pixels() == 1) << i;
}

/// Iterations to a relative residual of 1e-5; weights differ by up to 10, too much for alternating directions.
int iterations(Resolution size, double alpha) {
  const RandomProblem random(size, 6, static_cast<float>(alpha * alpha));
  const ReconstructionResult result = solve(random.problem(), {});
  EXPECT_TRUE(result.statistics.converged);
  return result.statistics.iterations;
}

/// Plain conjugate gradients take some 90 iterations for 0.2 and 1,700 for 0.01 (the root of the condition number,
/// 8 / alpha^2).
TEST(Multigrid, TakesFewIterationsForAnyAlphaAndSize) {
  for (const double alpha : {0.2, 0.05, 0.01, 0.001})
    for (const Resolution size : {Resolution{64, 64}, Resolution{257, 129}, Resolution{400, 401}})
      EXPECT_LE(iterations(size, alpha), 20) << alpha << ", " << size.width;
}

/// A line of gradients with next to no weight, at odd and even columns, and weights that differ by a factor of 1e4
/// beside it: a line within a coarser level's pixels is not seen there.
TEST(Multigrid, TakesFewIterationsAcrossEdges) {
  for (const int column : {40, 41}) {
    constexpr Resolution k_size{101, 97};
    RandomProblem random(k_size, 7, 1e-4f);
    for (int y = 0; y < k_size.height; ++y) {
      random.weights.dx(column, y) = 1e-6f;
      for (int x = 0; x < column; ++x) random.weights.dx(x, y) *= 1e-4f, random.weights.dy(x, y) *= 1e-4f;
    }
    const ReconstructionResult result = solve(random.problem(), {});
    EXPECT_TRUE(result.statistics.converged);
    EXPECT_LE(result.statistics.iterations, 60);
  }
}

}  // namespace
}  // namespace gradslc
