#include "core/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "support/random.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

constexpr double k_last_below_one = 1 - 0x1p-53;

TEST(DiscreteDistribution, ProbabilityIsWeightOverTotal) {
  const DiscreteDistribution distribution({1, 0, 3, 4});
  EXPECT_EQ(distribution.size(), 4u);
  EXPECT_DOUBLE_EQ(distribution.total(), 8);
  EXPECT_DOUBLE_EQ(distribution.probability(0), 0.125);
  EXPECT_EQ(distribution.probability(1), 0);
  EXPECT_DOUBLE_EQ(distribution.probability(2), 0.375);
  EXPECT_DOUBLE_EQ(distribution.probability(3), 0.5);
}

TEST(DiscreteDistribution, SampleSaysItsProbabilityAndProbabilitiesSumToOne) {
  TestRandom random(1);
  std::vector<double> weights;
  for (int i = 0; i < 1000; ++i) weights.push_back(i % 3 == 0 ? 0 : std::pow(10.0, 20 * random.get1_double() - 10));
  const DiscreteDistribution distribution(weights);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += distribution.probability(i);
  EXPECT_NEAR(sum, 1, 1e-12);
  for (int i = 0; i < 100'000; ++i) {
    const auto sample = distribution.sample(random.get1_double());
    ASSERT_EQ(sample.probability, distribution.probability(sample.index));
    ASSERT_GT(sample.probability, 0);
    ASSERT_GT(weights[sample.index], 0);
    ASSERT_TRUE(sample.remapped >= 0 && sample.remapped < 1);
  }
}

TEST(DiscreteDistribution, NeverReturnsWeightZeroAtTheEnds) {
  const DiscreteDistribution distribution({0, 0, 0.1, 0, 0.7, 0.3, 0, 0});
  EXPECT_EQ(distribution.sample(0).index, 2u);
  EXPECT_EQ(distribution.sample(k_last_below_one).index, 5u);
  EXPECT_LT(distribution.sample(k_last_below_one).remapped, 1);
  // At the border between two indices, u belongs to the upper one.
  EXPECT_EQ(distribution.sample(distribution.probability(2)).index, 4u);
}

// False alarm 0.1 %.
TEST(DiscreteDistribution, FollowsItsProbabilitiesAndRemapsUniformly) {
  const std::vector<double> weights{5, 1, 0, 2, 12, 0.5};
  const DiscreteDistribution distribution(weights);
  constexpr int samples = 200'000;
  std::vector<double> observed(weights.size()), expected, remapped(16);
  for (const double weight : weights) expected.push_back(samples * weight / 20.5);
  TestRandom random(2);
  for (int i = 0; i < samples; ++i) {
    const auto sample = distribution.sample(random.get1_double());
    observed[sample.index] += 1;
    remapped[static_cast<std::size_t>(sample.remapped * 16)] += 1;
  }
  EXPECT_GT(chi_square_test(observed, expected).p_value, sidak(1e-3, 2));
  EXPECT_GT(chi_square_uniform(remapped).p_value, sidak(1e-3, 2));
}

TEST(DiscreteDistribution, OfNothingHasTotalZero) {
  EXPECT_EQ(DiscreteDistribution().size(), 0u);
  EXPECT_EQ(DiscreteDistribution(std::vector<double>()).total(), 0);
  EXPECT_EQ(DiscreteDistribution({0.0, 0.0}).total(), 0);
  EXPECT_EQ(DiscreteDistribution({0.0, 0.0}).probability(1), 0);
}

}  // namespace
}  // namespace gradslc
