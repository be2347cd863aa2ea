#include "vpl/density.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/parallel.h"

namespace gradslc {
namespace {

/// (k - 1) / (pi r_k^2), r_k the distance to the k-th nearest other VPL; 0 where that distance is 0.
double density_at(std::span<const Vpl> vpls, std::size_t index, std::size_t k) {
  std::vector<float> nearest;  // max-heap of the k smallest squared distances
  nearest.reserve(k + 1);
  for (std::size_t i = 0; i < vpls.size(); ++i) {
    if (i == index) continue;
    const float d2 = distance_squared(vpls[i].position, vpls[index].position);
    if (nearest.size() == k && d2 >= nearest.front()) continue;
    nearest.push_back(d2);
    std::push_heap(nearest.begin(), nearest.end());
    if (nearest.size() > k) {
      std::pop_heap(nearest.begin(), nearest.end());
      nearest.pop_back();
    }
  }
  const double r2 = nearest.front();
  return r2 > 0 ? static_cast<double>(k - 1) / (std::numbers::pi * r2) : 0;
}

}  // namespace

double inverse_covered_area(std::span<const Vpl> vpls) {
  constexpr std::size_t k_queries = 256, k_neighbours = 16;
  const std::size_t n = vpls.size();
  if (n < 3) return 0;
  const std::size_t k = std::min(k_neighbours, n - 1);
  const std::size_t queries = std::min(n, k_queries);
  const double sum = parallel_sum<double>(
      queries, 1, [&](std::size_t query, std::size_t) { return density_at(vpls, query * n / queries, k); });
  return sum / static_cast<double>(queries) / static_cast<double>(n);
}

double automatic_bound(std::span<const Vpl> pilot, double kappa) {
  return std::numbers::pi * static_cast<double>(pilot.size()) * inverse_covered_area(pilot) / kappa;
}

}  // namespace gradslc
