#pragma once
// What statistical tests judge by. A p-value is the probability of a result at least as extreme if nothing is wrong: a
// test that fails below alpha has the false-alarm rate alpha. Seeds of tests are fixed, so the alarm is raised by a
// change of the code and not by chance from run to run.

#include <cstddef>
#include <cstdint>
#include <span>

namespace gradslc {

/// P(Z <= z) of the standard normal distribution.
double normal_cdf(double z);
/// P(|Z| >= |z|) of the standard normal distribution.
double normal_p_value(double z);
/// P(|T| >= |t|) of Student's distribution with `degrees` > 0 degrees of freedom.
double student_t_p_value(double t, double degrees);
/// P(X >= statistic) of the chi-square distribution with `degrees` > 0 degrees of freedom.
double chi_square_p_value(double statistic, double degrees);
/// The level for each of `tests` independent tests such that one false alarm among all has probability `alpha`.
double sidak(double alpha, std::size_t tests);

/// Q(a, x) = Gamma(a, x) / Gamma(a), a > 0, x >= 0 (Abramowitz and Stegun 6.5.3).
double regularised_upper_gamma(double a, double x);
/// I_x(a, b), a, b > 0, 0 <= x <= 1 (Abramowitz and Stegun 26.5.1).
double regularised_beta(double a, double b, double x);

/// Count, mean and variance of a stream of numbers (Welford 1962).
class Moments {
 public:
  void add(double value);
  /// Adds all that `other` has seen (Chan, Golub and LeVeque 1979).
  void merge(const Moments& other);

  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased sample variance; 0 below two values.
  double variance() const;
  /// Standard error of the mean.
  double standard_error() const;
  /// Two-sided p-value of "the expectation is `expected`" (Student's t-test, at least two values). Where all values are
  /// equal: 1 if they are `expected` up to rounding, else 0.
  double p_value(double expected) const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// Two-sided p-value of "both have the same expectation" (Welch 1947; two values each at least).
double same_mean_p_value(const Moments& a, const Moments& b);

struct ChiSquare {
  double statistic = 0;
  int degrees = 0;     ///< cells after pooling - 1
  double p_value = 1;  ///< 0 where something was observed in a cell that expects nothing
};
/// Pearson's test of observed counts against expected ones. Cells that expect fewer than `min_expected` are pooled.
ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected, double min_expected = 5);
/// The same for counts that should be equal.
ChiSquare chi_square_uniform(std::span<const double> observed);

}  // namespace gradslc
