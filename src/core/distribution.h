#pragma once

#include <cstddef>
#include <vector>

namespace gradslc {

/// A discrete distribution over indices in proportion to non-negative weights; sums in double.
class DiscreteDistribution {
 public:
  DiscreteDistribution() = default;
  /// Weights must be finite and >= 0. All zero: total() is 0, and nothing may be sampled.
  explicit DiscreteDistribution(const std::vector<double>& weights);

  std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }
  double total() const { return total_; }
  double probability(std::size_t index) const { return cdf_[index + 1] - cdf_[index]; }

  struct Sample {
    std::size_t index;
    double probability;  ///< > 0
    float remapped;      ///< u stretched over the chosen index's interval, in [0,1): may be used once more
  };
  /// `u` in [0,1). Indices of weight zero are never returned.
  Sample sample(double u) const;

 private:
  std::vector<double> cdf_;  // cdf_[0] = 0 ... cdf_[size] = 1
  double total_ = 0;
};

}  // namespace gradslc
