#include "support/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace gradslc {
namespace {

constexpr double k_precision = std::numeric_limits<double>::epsilon();
constexpr double k_smallest = std::numeric_limits<double>::min() / k_precision;
constexpr int k_max_terms = 1'000'000;

double not_zero(double value) { return std::abs(value) < k_smallest ? k_smallest : value; }

/// Value of b0 + a1/(b1 + a2/(b2 + ...)) by the modified Lentz method (Thompson and Barnett 1986); term(i) = {a_i,
/// b_i}.
template <class Term>
double continued_fraction(double b0, const Term& term) {
  double value = not_zero(b0), c = value, d = 0;
  for (int i = 1; i < k_max_terms; ++i) {
    const auto [a, b] = term(i);
    d = 1 / not_zero(b + a * d);
    c = not_zero(b + a / c);
    value *= c * d;
    if (std::abs(c * d - 1) <= k_precision) break;
  }
  return value;
}

struct Fraction {
  double a, b;
};

/// P(a, x) by its power series (Abramowitz and Stegun 6.5.29); converges fast for x < a + 1.
double lower_gamma_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < k_max_terms && term > sum * k_precision; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// I_x(a, b) by its continued fraction (DLMF 8.17.22); converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  const double front =
      std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b));
  const double fraction = continued_fraction(1, [&](int i) -> Fraction {
    const double m = i / 2;  // NOLINT(bugprone-integer-division): the fraction's terms come in pairs
    if (i % 2 == 0) return {m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)), 1};
    return {-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)), 1};
  });
  return front / (a * fraction);
}

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double normal_p_value(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

double regularised_upper_gamma(double a, double x) {
  assert(a > 0 && x >= 0);
  if (x == 0) return 1;
  if (x < a + 1) return 1 - lower_gamma_series(a, x);
  const double fraction = continued_fraction(x + 1 - a, [&](int i) -> Fraction {
    return {i * (a - i), x + 2 * i + 1 - a};
  });
  return std::exp(a * std::log(x) - x - std::lgamma(a)) / fraction;
}

double regularised_beta(double a, double b, double x) {
  assert(a > 0 && b > 0 && x >= 0 && x <= 1);
  if (x == 0 || x == 1) return x;
  return x < (a + 1) / (a + b + 2) ? beta_fraction(a, b, x) : 1 - beta_fraction(b, a, 1 - x);
}

double student_t_p_value(double t, double degrees) {
  return regularised_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
}

double chi_square_p_value(double statistic, double degrees) {
  return regularised_upper_gamma(degrees / 2, statistic / 2);
}

double sidak(double alpha, std::size_t tests) {
  assert(tests > 0);
  return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

void Moments::add(double value) {
  ++count_;
  const double difference = value - mean_;
  mean_ += difference / static_cast<double>(count_);
  squares_ += difference * (value - mean_);
}

void Moments::merge(const Moments& other) {
  if (other.count_ == 0) return;
  const double difference = other.mean_ - mean_;
  const auto n = static_cast<double>(count_), m = static_cast<double>(other.count_);
  count_ += other.count_;
  mean_ += difference * m / (n + m);
  squares_ += other.squares_ + difference * difference * n * m / (n + m);
}

double Moments::variance() const { return count_ < 2 ? 0 : squares_ / static_cast<double>(count_ - 1); }

double Moments::standard_error() const { return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_)); }

double Moments::p_value(double expected) const {
  assert(count_ >= 2);
  const double error = standard_error();
  if (error > 0) return student_t_p_value((mean_ - expected) / error, static_cast<double>(count_ - 1));
  constexpr double rounding = 1e-6;  // values come from transport in float
  return std::abs(mean_ - expected) <= rounding * std::abs(expected) ? 1 : 0;
}

double same_mean_p_value(const Moments& a, const Moments& b) {
  assert(a.count() >= 2 && b.count() >= 2);
  const double va = a.variance() / static_cast<double>(a.count()), vb = b.variance() / static_cast<double>(b.count());
  if (va + vb == 0) return a.mean() == b.mean() ? 1 : 0;
  const double degrees = (va + vb) * (va + vb) /
                         (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return student_t_p_value((a.mean() - b.mean()) / std::sqrt(va + vb), degrees);
}

ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected, double min_expected) {
  assert(observed.size() == expected.size());
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

  ChiSquare result;
  int cells = 0;
  double pooled_observed = 0, pooled_expected = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t cell = order[rank];
    if (expected[cell] == 0 && observed[cell] > 0) return {std::numeric_limits<double>::infinity(), 0, 0};
    pooled_observed += observed[cell];
    pooled_expected += expected[cell];
    const bool last = rank + 1 == order.size();
    if (pooled_expected < min_expected && !last) continue;
    if (pooled_expected == 0) continue;
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    ++cells;
    pooled_observed = pooled_expected = 0;
  }
  result.degrees = cells - 1;
  result.p_value = result.degrees > 0 ? chi_square_p_value(result.statistic, result.degrees) : 1;
  return result;
}

ChiSquare chi_square_uniform(std::span<const double> observed) {
  const double total = std::accumulate(observed.begin(), observed.end(), 0.0);
  const std::vector<double> expected(observed.size(), total / static_cast<double>(observed.size()));
  return chi_square_test(observed, expected);
}

}  // namespace gradslc
