#include "core/distribution.h"

#include <algorithm>
#include <cassert>

#include "core/constants.h"

namespace gradslc {

DiscreteDistribution::DiscreteDistribution(const std::vector<double>& weights) : cdf_(weights.size() + 1, 0) {
  std::size_t last_positive = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    assert(weights[i] >= 0);
    cdf_[i + 1] = cdf_[i] + weights[i];
    if (weights[i] > 0) last_positive = i;
  }
  total_ = cdf_.back();
  if (total_ == 0) return;
  for (double& value : cdf_) value /= total_;
  std::fill(cdf_.begin() + static_cast<std::ptrdiff_t>(last_positive) + 1, cdf_.end(), 1.0);
}

DiscreteDistribution::Sample DiscreteDistribution::sample(double u) const {
  assert(total_ > 0 && u >= 0 && u < 1);
  // The last index with cdf_[index] <= u, by bisection whose steps a processor need not guess.
  std::size_t index = 0;
  for (std::size_t left = size(); left > 1;) {
    const std::size_t half = left / 2;
    index += cdf_[index + half] <= u ? half : 0;
    left -= half;
  }
  const double p = probability(index);
  return {index, p, std::min(static_cast<float>((u - cdf_[index]) / p), k_one_minus_epsilon)};
}

}  // namespace gradslc
