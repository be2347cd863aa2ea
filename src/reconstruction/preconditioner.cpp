#include "reconstruction/preconditioner.h"

#include <algorithm>
#include <limits>

#include "reconstruction/alternating_directions.h"
#include "reconstruction/multigrid.h"

namespace gradslc {
namespace {

/// Of the weights of one term.
struct WeightRange {
  double least = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
  std::size_t number = 0;

  double mean() const { return number > 0 ? sum / static_cast<double>(number) : 0; }
  bool within(double factor) const { return number == 0 || largest == 0 || largest <= factor * least; }
};

WeightRange range_of(const Image<float>& weights, Resolution used) {
  WeightRange range;
  for (int y = 0; y < used.height; ++y)
    for (int x = 0; x < used.width; ++x) {
      const auto weight = static_cast<double>(weights(x, y));
      range.least = std::min(range.least, weight), range.largest = std::max(range.largest, weight);
      range.sum += weight, ++range.number;
    }
  return range;
}

}  // namespace

std::unique_ptr<Preconditioner> make_preconditioner(const PoissonWeights& weights) {
  constexpr double k_alike = 4, k_equal = 1.001;
  constexpr double k_remaining = 0.1, k_remaining_of_equal = 4e-3;  // two iterations then leave less than 1e-5
  const Resolution all = weights.primal.resolution();
  const WeightRange primal = range_of(weights.primal, all);
  const WeightRange dx = range_of(weights.dx, {all.width - 1, all.height});
  const WeightRange dy = range_of(weights.dy, {all.width, all.height - 1});
  const auto all_within = [&](double factor) {
    return primal.largest > 0 && primal.within(factor) && dx.within(factor) && dy.within(factor);
  };
  if (!all_within(k_alike)) return std::make_unique<Multigrid>(weights);
  return std::make_unique<AlternatingDirections>(all, UniformWeights{primal.mean(), dx.mean(), dy.mean()},
                                                 all_within(k_equal) ? k_remaining_of_equal : k_remaining);
}

}  // namespace gradslc
