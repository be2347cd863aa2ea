#include "experiments/statistics.h"

#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <limits>

namespace gradslc {

double student_t_quantile(double probability, int degrees_of_freedom) {
  assert(probability > 0 && probability < 1 && degrees_of_freedom >= 1);
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), probability);
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
