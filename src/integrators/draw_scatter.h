#pragma once

#include <cstdint>

namespace gradslc {

/// The variance of a sum of systematic draws, from their successive differences (Wolter 1984, estimator v2).
class DrawScatter {
 public:
  /// `count` draws in succession, each of which has brought `value`.
  void add(float value, std::uint32_t count) {
    if (draws_ > 0) squares_ += (value - last_) * (value - last_);
    last_ = value, draws_ += count;
  }
  /// Variance that a sum of `samples` draws would have if it were made by one; 0 where nothing can be told.
  float variance_of_one(int samples) const {
    if (draws_ < 2) return 0;
    const auto draws = static_cast<float>(draws_);
    return static_cast<float>(samples) * draws * squares_ / (2 * (draws - 1));
  }

 private:
  float last_ = 0, squares_ = 0;
  std::uint32_t draws_ = 0;
};

}  // namespace gradslc
