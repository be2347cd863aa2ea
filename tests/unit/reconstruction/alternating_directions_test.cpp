#include "reconstruction/alternating_directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/reconstruction/random_problem.h"

namespace gradslc {
namespace {

constexpr Resolution k_sizes[] = {{1, 1}, {1, 13}, {13, 1}, {2, 2}, {5, 7}, {31, 8}, {64, 64}, {97, 61}, {130, 3}};

Field random_field(Resolution size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-1, 1);
  Field field(size);
  for (float& v : field) v = value(random);
  return field;
}

/// A x, from the definition.
Field product(const UniformWeights& weights, Resolution size, const Field& x) {
  Field result(size);
  for (int channel = 0; channel < 3; ++channel) {
    const std::size_t plane = static_cast<std::size_t>(channel) * size.pixels();
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      const Pixel pixel = size.pixel(i);
      const auto here = static_cast<double>(x[plane + i]);
      double sum = weights.primal * here;
      const auto add = [&](Pixel step, double weight) {
        if (size.contains(pixel + step))
          sum += weight * (here - static_cast<double>(x[plane + size.index(pixel + step)]));
      };
      add({-1, 0}, weights.dx), add({1, 0}, weights.dx), add({0, -1}, weights.dy), add({0, 1}, weights.dy);
      result[plane + i] = static_cast<float>(sum);
    }
  }
  return result;
}

double norm(const Field& field) {
  double sum = 0;
  for (const float value : field) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum);
}

TEST(AlternatingDirections, LeavesNoMoreOfAnErrorThanAsked) {
  for (const UniformWeights weights : {UniformWeights{0.04, 1, 1}, {1e-4, 1, 0.5}, {1, 1, 1}, {10, 0.1, 1}, {1, 0, 0}})
    for (const double remaining : {0.5, 0.1, 1e-2, 1e-3})
      for (const Resolution size : k_sizes) {
        const Field x = random_field(size, 1), b = product(weights, size, x);
        Field found(size), scratch(size);
        AlternatingDirections(size, weights, remaining).apply(b, found, scratch);
        for (std::size_t i = 0; i < x.size(); ++i) found[i] -= x[i];
        EXPECT_LE(norm(found), (remaining + 1e-4) * norm(x))
            << size.width << " x " << size.height << ", primal " << weights.primal << ", " << remaining;
      }
}

TEST(AlternatingDirections, IsSymmetricAndPositive) {
  for (const Resolution size : k_sizes) {
    AlternatingDirections approximation(size, {0.01, 1, 2}, 0.3);
    const Field u = random_field(size, 2), v = random_field(size, 3);
    Field mu(size), mv(size), scratch(size);
    approximation.apply(u, mu, scratch), approximation.apply(v, mv, scratch);
    double uv = 0, vu = 0, uu = 0, vv = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const auto product = [&](const Field& a, const Field& b) {
        return static_cast<double>(a[i]) * static_cast<double>(b[i]);
      };
      uv += product(u, mv), vu += product(v, mu), uu += product(u, mu), vv += product(v, mv);
    }
    EXPECT_NEAR(uv, vu, 1e-5 * std::sqrt(uu * vv)) << size.width << " x " << size.height;
    EXPECT_GT(uu, 0);
  }
}

/// Of the order of the logarithms of the condition and of what may remain (Wachspress 1966).
TEST(AlternatingDirections, NeedsFewSteps) {
  const auto steps = [](double alpha, double remaining) {
    return AlternatingDirections({8, 8}, {alpha * alpha, 1, 1}, remaining).steps();
  };
  EXPECT_EQ(steps(1, 0.1), 2);
  EXPECT_EQ(steps(0.2, 4e-3), 5);
  EXPECT_EQ(steps(0.01, 4e-3), 9);
  EXPECT_LE(steps(1e-4, 4e-3), 20);
}

/// Weights that differ by a factor of 4, as counts of samples do, as a preconditioner; and plain conjugate gradients.
TEST(AlternatingDirections, PreconditionsWeightsThatAreNearlyAlike) {
  constexpr Resolution k_size{131, 90};
  RandomProblem random(k_size, 6);
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> factor(1, 4);
  for (float& weight : random.weights.primal) weight = 1e-3f * factor(engine);
  for (Image<float>* term : {&random.weights.dx, &random.weights.dy})
    for (float& weight : *term) weight = factor(engine);
  const ReconstructionResult result = solve(random.problem(), {.relative_residual = 1e-6});
  EXPECT_TRUE(result.statistics.converged);
  EXPECT_LE(result.statistics.iterations, 16);
  const ReconstructionResult plain = solve(random.problem(), {.relative_residual = 1e-6, .preconditioned = false});
  EXPECT_TRUE(plain.statistics.converged);
  EXPECT_GE(plain.statistics.iterations, 100);
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < k_size.pixels(); ++i)
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<double>(result.image[i][c]), b = static_cast<double>(plain.image[i][c]);
      difference += (a - b) * (a - b), size += b * b;
    }
  EXPECT_LE(std::sqrt(difference / size), 1e-3);  // the residual's bound times the condition number, at most
}

}  // namespace
}  // namespace gradslc
