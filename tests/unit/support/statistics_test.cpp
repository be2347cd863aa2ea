#include "support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/random.h"

namespace gradslc {
namespace {

TEST(NormalDistribution, HasTabulatedValues) {
  EXPECT_DOUBLE_EQ(normal_cdf(0), 0.5);
  EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-14);
  EXPECT_NEAR(normal_cdf(-3), 0.0013498980316301, 1e-15);
  EXPECT_NEAR(normal_p_value(-2.575829303548901), 0.01, 1e-14);
}

TEST(StudentDistribution, HasClosedFormsAndTabulatedValues) {
  for (const double t : {0.1, 1.0, 3.0, 40.0}) {
    EXPECT_NEAR(student_t_p_value(t, 1), 1 - 2 * std::numbers::inv_pi * std::atan(t), 1e-13);
    EXPECT_NEAR(student_t_p_value(-t, 2), 1 - t / std::sqrt(2 + t * t), 1e-13);
  }
  EXPECT_DOUBLE_EQ(student_t_p_value(0, 5), 1);
  EXPECT_NEAR(student_t_p_value(2.2281388519862744, 10), 0.05, 1e-12);
  EXPECT_NEAR(student_t_p_value(2.5, 1e7), normal_p_value(2.5), 1e-7);
}

TEST(ChiSquareDistribution, HasClosedFormsAndTabulatedValues) {
  for (const double x : {0.01, 1.0, 5.0, 30.0, 200.0}) {
    EXPECT_NEAR(chi_square_p_value(x, 1) / normal_p_value(std::sqrt(x)), 1, 1e-10);
    EXPECT_NEAR(chi_square_p_value(x, 2) / std::exp(-x / 2), 1, 1e-10);
  }
  EXPECT_NEAR(chi_square_p_value(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_p_value(124.34211340400408, 100), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_p_value(1e6, 1e6), 0.5, 1e-3);  // median near degrees - 2/3
}

TEST(Sidak, KeepsTheLevelOfAllTestsTogether) {
  EXPECT_DOUBLE_EQ(sidak(0.05, 1), 0.05);
  EXPECT_NEAR(sidak(0.05, 10), 0.005116196891823743, 1e-15);
  EXPECT_NEAR(1 - std::pow(1 - sidak(1e-3, 1000), 1000), 1e-3, 1e-12);
}

TEST(Moments, OfKnownNumbers) {
  Moments moments;
  for (const double value : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) moments.add(value);
  EXPECT_EQ(moments.count(), 4u);
  EXPECT_DOUBLE_EQ(moments.mean(), 1e9 + 10);
  EXPECT_DOUBLE_EQ(moments.variance(), 30);
  EXPECT_DOUBLE_EQ(moments.standard_error(), std::sqrt(7.5));
  EXPECT_NEAR(moments.p_value(1e9 + 10 - std::sqrt(7.5)), student_t_p_value(1, 3), 1e-7);
}

TEST(Moments, OfEqualNumbersAreJudgedByEquality) {
  Moments moments;
  for (int i = 0; i < 3; ++i) moments.add(0.25);
  EXPECT_EQ(moments.p_value(0.25), 1);
  EXPECT_EQ(moments.p_value(0.2501), 0);
}

TEST(Moments, MergeLikeOneStream) {
  TestRandom random(3);
  Moments all, first, second;
  for (int i = 0; i < 1000; ++i) {
    const double value = random.get1_double();
    all.add(value);
    (i < 300 ? first : second).add(value);
  }
  first.merge(second);
  first.merge(Moments());
  EXPECT_EQ(first.count(), all.count());
  EXPECT_NEAR(first.mean(), all.mean(), 1e-14);
  EXPECT_NEAR(first.variance(), all.variance(), 1e-14);
}

TEST(SameMean, SeesADifferenceAndNothingElse) {
  TestRandom random(5);
  Moments a, b, shifted;
  for (int i = 0; i < 10000; ++i) {
    a.add(random.get1_double());
    b.add(2 * random.get1_double() - 0.5);
    shifted.add(random.get1_double() + 0.03);
  }
  EXPECT_GT(same_mean_p_value(a, b), 1e-3);
  EXPECT_LT(same_mean_p_value(a, shifted), 1e-6);
}

TEST(ChiSquareTest, OfAWorkedExample) {
  // 60 throws of a die: (5-10)^2/10 + (8-10)^2/10 + (9-10)^2/10 + (8-10)^2/10 + (10-10)^2/10 + (20-10)^2/10 = 13.4
  const ChiSquare die = chi_square_uniform(std::array{5.0, 8.0, 9.0, 8.0, 10.0, 20.0});
  EXPECT_DOUBLE_EQ(die.statistic, 13.4);
  EXPECT_EQ(die.degrees, 5);
  EXPECT_NEAR(die.p_value, 0.0199, 1e-4);
}

TEST(ChiSquareTest, PoolsRareCells) {
  const ChiSquare pooled = chi_square_test(std::array{1.0, 2.0, 4.0, 93.0}, std::array{1.0, 2.0, 3.0, 94.0});
  EXPECT_EQ(pooled.degrees, 1);
  EXPECT_DOUBLE_EQ(pooled.statistic, 1.0 / 6 + 1.0 / 94);
}

TEST(ChiSquareTest, FailsWhereNothingIsExpected) {
  EXPECT_EQ(chi_square_test(std::array{1.0, 999.0}, std::array{0.0, 1000.0}).p_value, 0);
  EXPECT_EQ(chi_square_test(std::array{0.0, 500.0, 500.0}, std::array{0.0, 500.0, 500.0}).p_value, 1);
}

// The p-values of a fair die are uniform: their mean over 2000 repetitions is 1/2. False alarm 0.1 %.
TEST(ChiSquareTest, HasTheFalseAlarmRateThatItSays) {
  TestRandom random(11);
  Moments p_values, alarms;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    std::vector<double> counts(20, 0.0);
    for (int i = 0; i < 1000; ++i) counts[random.below(20)] += 1;
    const double p = chi_square_uniform(counts).p_value;
    p_values.add(p);
    alarms.add(p < 0.05 ? 1 : 0);
  }
  EXPECT_GT(p_values.p_value(0.5), sidak(1e-3, 2));
  EXPECT_GT(alarms.p_value(0.05), sidak(1e-3, 2));
}

}  // namespace
}  // namespace gradslc
