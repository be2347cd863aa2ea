#pragma once

#include <span>

namespace gradslc {

/// The value t with P(T <= t) = probability for Student's t distribution; probability in (0, 1), degrees_of_freedom
/// >= 1.
double student_t_quantile(double probability, int degrees_of_freedom);

/// Mean of some repeats and half the width of its 95 % confidence interval by Student's t.
struct Estimate {
  double mean = 0;
  double half_width = 0;  ///< infinite with fewer than two values
  int count = 0;

  double lower() const { return mean - half_width; }
  double upper() const { return mean + half_width; }
};
/// Values must be finite; none gives a mean of NaN.
Estimate estimate_mean(std::span<const double> values);

/// Whether the intervals have a value in common. True where one is infinite.
bool intervals_overlap(const Estimate& a, const Estimate& b);

}  // namespace gradslc
