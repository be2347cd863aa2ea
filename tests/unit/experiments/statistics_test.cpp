#include "experiments/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace gradslc {
namespace {

TEST(StudentT, QuantilesAgreeWithPublishedTables) {
  struct Entry {
    double probability;
    int degrees;
    double t;
  };
  // Abramowitz and Stegun 1964, table 26.10.
  for (const Entry& e :
       {Entry{0.975, 1, 12.706}, Entry{0.975, 2, 4.303}, Entry{0.975, 5, 2.571}, Entry{0.975, 10, 2.228},
        Entry{0.975, 30, 2.042}, Entry{0.975, 120, 1.980}, Entry{0.95, 4, 2.132}, Entry{0.995, 3, 5.841}}) {
    EXPECT_NEAR(student_t_quantile(e.probability, e.degrees), e.t, 5.1e-4) << e.probability << " " << e.degrees;
  }
}

TEST(StudentT, QuantilesAgreeWithClosedForms) {
  const double p = 0.9;
  EXPECT_NEAR(student_t_quantile(p, 1), std::tan(M_PI * (p - 0.5)), 1e-9) << "Cauchy";
  EXPECT_NEAR(student_t_quantile(p, 2), (2 * p - 1) * std::sqrt(2 / (4 * p * (1 - p))), 1e-9);
  EXPECT_NEAR(student_t_quantile(0.5, 7), 0, 1e-9);
  EXPECT_NEAR(student_t_quantile(0.025, 6), -student_t_quantile(0.975, 6), 1e-12);
}

TEST(EstimateMean, GivesMeanAndInterval) {
  const Estimate e = estimate_mean(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(e.mean, 2.5);
  EXPECT_NEAR(e.half_width, 3.182446 * std::sqrt(5.0 / 3) / 2, 1e-5);
  EXPECT_EQ(e.count, 4);
}

TEST(EstimateMean, OneValueHasNoInterval) {
  const Estimate e = estimate_mean(std::vector<double>{7});
  EXPECT_EQ(e.mean, 7);
  EXPECT_EQ(e.half_width, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(intervals_overlap(e, estimate_mean(std::vector<double>{100, 100.1})));
}

TEST(Intervals, OverlapOrNot) {
  EXPECT_TRUE(intervals_overlap({1, 0.5, 3}, {2, 0.5, 3}));
  EXPECT_FALSE(intervals_overlap({1, 0.4, 3}, {2, 0.5, 3}));
  EXPECT_FALSE(intervals_overlap({2, 0.5, 3}, {1, 0.4, 3}));
}

}  // namespace
}  // namespace gradslc
