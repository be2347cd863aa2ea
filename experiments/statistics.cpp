#include "experiments/statistics.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace gradslc {
namespace {

/// Continued fraction of the incomplete beta function by Lentz's method (Abramowitz and Stegun 26.5.8);
/// converges fast for x < (a + 1) / (a + b + 2).
double beta_continued_fraction(double a, double b, double x) {
  constexpr double k_tiny = 1e-300, k_precision = 1e-15;
  constexpr int k_max_terms = 1000;
  const auto away_from_zero = [](double v) { return std::abs(v) < k_tiny ? k_tiny : v; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), result = d;
  for (int m = 1; m <= k_max_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : {even, odd}) {
      d = 1 / away_from_zero(1 + term * d);
      c = away_from_zero(1 + term / c);
      step = c * d;
      result *= step;
    }
    if (std::abs(step - 1) < k_precision) break;
  }
  return result;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_continued_fraction(a, b, x) / a;
  return 1 - front * beta_continued_fraction(b, a, 1 - x) / b;
}

/// P(T > t) for t >= 0.
double student_t_tail(double t, int degrees_of_freedom) {
  return incomplete_beta(degrees_of_freedom / 2.0, 0.5, degrees_of_freedom / (degrees_of_freedom + t * t)) / 2;
}

}  // namespace

double student_t_quantile(double probability, int degrees_of_freedom) {
  assert(probability > 0 && probability < 1 && degrees_of_freedom >= 1);
  if (probability < 0.5) return -student_t_quantile(1 - probability, degrees_of_freedom);
  const double tail = 1 - probability;
  double lower = 0, upper = 1;
  while (student_t_tail(upper, degrees_of_freedom) > tail) upper *= 2;
  while (true) {
    const double middle = lower + (upper - lower) / 2;
    if (middle <= lower || middle >= upper) return middle;
    (student_t_tail(middle, degrees_of_freedom) > tail ? lower : upper) = middle;
  }
}

Estimate estimate_mean(std::span<const double> values) {
  const int count = static_cast<int>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  if (count < 2) return {mean, std::numeric_limits<double>::infinity(), count};
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double standard_error = std::sqrt(squares / (count - 1) / count);
  return {mean, student_t_quantile(0.975, count - 1) * standard_error, count};
}

bool intervals_overlap(const Estimate& a, const Estimate& b) {
  return a.lower() <= b.upper() && b.lower() <= a.upper();
}

}  // namespace gradslc
