#include "reconstruction/alternating_directions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gradslc {
namespace {

constexpr std::size_t k_most_steps = 64;  // enough for any weights that floats can hold

/// n shifts for eigenvalues in [lowest, highest], near the best there are: Jacobi's elliptic function dn, by the first
/// terms of its theta series (Wachspress 1966, chapter 6).
std::vector<double> shifts(double lowest, double highest, std::size_t n) {
  const double ratio = lowest / highest, nome = ratio * ratio / 16 * (1 + ratio * ratio / 2);
  std::vector<double> found;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    found.push_back(highest * std::sqrt(ratio) * std::pow(nome, (2 * r - 1) / 4) *
                    (1 + std::pow(nome, 1 - r) + std::pow(nome, 1 + r)) /
                    (1 + std::pow(nome, r) + std::pow(nome, 2 - r)));
  }
  return found;
}

/// The largest product of |s - x| / (s + x) over the shifts, for any x in the interval.
double largest_product(double lowest, double highest, const std::vector<double>& shifts) {
  constexpr std::size_t k_samples = 500;
  double largest = 0;
  for (std::size_t k = 0; k <= k_samples; ++k) {
    const double x = lowest * std::pow(highest / lowest, static_cast<double>(k) / k_samples);
    double product = 1;
    for (const double shift : shifts) product *= std::abs(shift - x) / (shift + x);
    largest = std::max(largest, product);
  }
  return largest;
}

}  // namespace

AlternatingDirections::AlternatingDirections(Resolution resolution, const UniformWeights& weights, double remaining)
    : resolution_(resolution) {
  const double lowest = weights.primal / 2, highest = lowest + 4 * std::max(weights.dx, weights.dy);
  std::vector<double> chosen = shifts(lowest, highest, 1);
  while (chosen.size() < k_most_steps && std::pow(largest_product(lowest, highest, chosen), 2) > remaining)
    chosen = shifts(lowest, highest, chosen.size() + 1);
  for (const double shift : chosen)
    steps_.push_back({shift, factorised(resolution.width, shift + lowest, weights.dx),
                      factorised(resolution.height, shift + lowest, weights.dy)});
}

AlternatingDirections::Line AlternatingDirections::factorised(int pixels, double diagonal, double weight) {
  Line line{static_cast<float>(weight), {}};
  double inverse = 0;
  for (int i = 0; i < pixels; ++i) {
    const int neighbours = (i > 0) + (i + 1 < pixels);
    inverse = 1 / (diagonal + neighbours * weight - (i > 0 ? weight * weight * inverse : 0));
    line.inverse_pivots.push_back(static_cast<float>(inverse));
  }
  return line;
}

void AlternatingDirections::apply(const Field& residual, Field& result, Field& scratch) {
  double previous = 0;
  for (const Step& step : steps_) {
    // The right-hand sides need neither H nor V: what (s + V) u was is known from the solution before.
    solve_rows(step.along_x, static_cast<float>(previous + step.shift), previous == 0, residual, result, scratch);
    solve_columns(step.along_y, static_cast<float>(2 * step.shift), residual, result, scratch);
    previous = step.shift;
  }
}

void AlternatingDirections::solve_rows(const Line& line, float scale, bool first, const Field& b, Field& u,
                                       Field& rhs) const {
  constexpr std::size_t k_together = 8;  // rows whose recurrences do not wait for each other
  const auto width = static_cast<std::size_t>(resolution_.width);
  const std::size_t rows = u.size() / width;
  const auto solve = [&]<std::size_t k_rows>(std::size_t row, std::array<float, k_rows> value) {
    const std::size_t begin = row * width;
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t k = 0; k < k_rows; ++k) {
        const std::size_t i = begin + k * width + x;
        rhs[i] = first ? b[i] : b[i] + scale * u[i] - rhs[i];
        u[i] = value[k] = (rhs[i] + line.off_diagonal * value[k]) * line.inverse_pivots[x];
      }
    for (std::size_t x = width - 1; x-- > 0;)
      for (std::size_t k = 0; k < k_rows; ++k) {
        const std::size_t i = begin + k * width + x;
        value[k] = u[i] += line.off_diagonal * line.inverse_pivots[x] * value[k];
      }
  };
  parallel_for(rows, k_together, [&](std::size_t begin, std::size_t end) {
    if (end - begin == k_together) return solve(begin, std::array<float, k_together>{});
    for (std::size_t row = begin; row < end; ++row) solve(row, std::array<float, 1>{});
  });
}

void AlternatingDirections::solve_columns(const Line& line, float scale, const Field& b, Field& u, Field& rhs) const {
  constexpr std::size_t k_together = 64;  // columns: few enough to stay in the cache
  const auto width = static_cast<std::size_t>(resolution_.width), height = static_cast<std::size_t>(resolution_.height);
  const std::size_t strips = (width + k_together - 1) / k_together;
  parallel_for(k_field_channels * strips, 1, [&](std::size_t strip, std::size_t) {
    const std::size_t first = strip % strips * k_together, columns = std::min(k_together, width - first);
    const std::size_t begin = strip / strips * resolution_.pixels() + first;
    std::array<float, k_together> above = {};
    for (std::size_t y = 0; y < height; ++y) {
      float* __restrict u_row = &u[begin + y * width], * __restrict rhs_row = &rhs[begin + y * width];
      const float *b_row = &b[begin + y * width], inverse = line.inverse_pivots[y];
      for (std::size_t x = 0; x < columns; ++x) {
        rhs_row[x] = b_row[x] + scale * u_row[x] - rhs_row[x];
        u_row[x] = above[x] = (rhs_row[x] + line.off_diagonal * above[x]) * inverse;
      }
    }
    for (std::size_t y = height - 1; y-- > 0;) {
      float* __restrict row = &u[begin + y * width];
      const float *below = row + width, factor = line.off_diagonal * line.inverse_pivots[y];
      for (std::size_t x = 0; x < columns; ++x) row[x] += factor * below[x];
    }
  });
}

}  // namespace gradslc
