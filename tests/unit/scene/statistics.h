#pragma once
// The two p-values that this room's tests need.

#include <cmath>
#include <cstddef>
#include <vector>

namespace gradslc::test {

/// P(|Z| >= |z|) of the standard normal distribution.
inline double normal_p_value(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

/// Level of each of `tests` tests for a false alarm of `alpha` among all.
inline double sidak(double alpha, std::size_t tests) {
  return 1 - std::pow(1 - alpha, 1.0 / static_cast<double>(tests));
}

/// Mean of a stream of numbers and the p-value of what it should be.
class Mean {
 public:
  void add(double value) { ++count_, sum_ += value, squares_ += value * value; }
  double mean() const { return sum_ / count_; }
  double standard_error() const { return std::sqrt(std::max(0.0, squares_ / count_ - mean() * mean()) / (count_ - 1)); }
  double p_value(double expected) const { return normal_p_value((mean() - expected) / standard_error()); }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

/// P-value of Pearson's chi-square test; cells that expect fewer than 5 are pooled (Wilson and Hilferty 1931's normal
/// approximation of the distribution).
inline double chi_square_p_value(const std::vector<double>& observed, const std::vector<double>& expected) {
  double statistic = 0, pooled_observed = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double o, double e) { statistic += (o - e) * (o - e) / e, ++cells; };
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] >= 5)
      add(observed[i], expected[i]);
    else
      pooled_observed += observed[i], pooled_expected += expected[i];
  }
  if (pooled_expected > 0) add(pooled_observed, pooled_expected);
  if (pooled_expected == 0 && pooled_observed > 0) return 0;  // seen where nothing can be
  const double degrees = cells - 1, spread = 2 / (9 * degrees);
  const double z = (std::cbrt(statistic / degrees) - (1 - spread)) / std::sqrt(spread);
  return std::erfc(z / std::numbers::sqrt2) / 2;
}

}  // namespace gradslc::test
