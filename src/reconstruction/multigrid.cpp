#include "reconstruction/multigrid.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr std::size_t k_channels = 3;
constexpr std::size_t k_coarsest_pixels = 16;
constexpr int k_coarsest_sweeps = 8;
constexpr std::size_t k_first_repeated_level = 0;  // levels below it are visited twice: a W-cycle
/// Of the two Jacobi sweeps before and after a coarser level: roots of the Chebyshev polynomial that is smallest where
/// eigenvalues of D^-1 A, which lie in [0, 2], are not for coarser levels to reduce: in [1/2, 2].
constexpr float k_damping[2] = {1.0f / (1.25f + 0.75f * 0.70710678f), 1.0f / (1.25f - 0.75f * 0.70710678f)};

/// Calls body(first row, row behind the last) on all threads, or at once where there is little to do.
template <class Body>
void for_rows(Resolution resolution, const Body& body) {
  constexpr std::size_t k_pixels_per_chunk = 16384;
  const auto rows = static_cast<std::size_t>(resolution.height);
  const std::size_t per_chunk =
      std::max<std::size_t>(1, k_pixels_per_chunk / static_cast<std::size_t>(resolution.width));
  if (rows <= per_chunk) return body(0, resolution.height);
  parallel_for(rows, per_chunk,
               [&](std::size_t begin, std::size_t end) { body(static_cast<int>(begin), static_cast<int>(end)); });
}

/// Weights that meet in a row; `above` and `below` are null at the image's border.
struct RowWeights {
  const float *primal, *right, *above, *below;
};
RowWeights weights_of_row(const PoissonWeights& weights, int y) {
  const int last = weights.primal.height() - 1;
  return {&weights.primal(0, y), &weights.dx(0, y), y > 0 ? &weights.dy(0, y - 1) : nullptr,
          y < last ? &weights.dy(0, y) : nullptr};
}

/// row = (rhs - A field) of row y of one channel, whose planes begin at `rhs` and `field`.
void residual_of_row(const PoissonWeights& weights, int y, const float* rhs, const float* field, float* row) {
  const RowWeights w = weights_of_row(weights, y);
  const int width = weights.primal.width();
  const std::ptrdiff_t first = std::ptrdiff_t{y} * width;
  const float *here = field + first, *above = here - width, *below = here + width, *b = rhs + first;
  for (int x = 0; x < width; ++x) row[x] = b[x] - w.primal[x] * here[x];
  if (w.above)
    for (int x = 0; x < width; ++x) row[x] += w.above[x] * (above[x] - here[x]);
  if (w.below)
    for (int x = 0; x < width; ++x) row[x] += w.below[x] * (below[x] - here[x]);
  for (int x = 1; x < width; ++x) row[x] += w.right[x - 1] * (here[x - 1] - here[x]);
  for (int x = 0; x + 1 < width; ++x) row[x] += w.right[x] * (here[x + 1] - here[x]);
}

/// The weights of 2 x 2 pixels as one.
PoissonWeights coarsened(const PoissonWeights& fine) {
  const Resolution from = fine.primal.resolution(), to{(from.width + 1) / 2, (from.height + 1) / 2};
  PoissonWeights coarse{Image<float>(to), Image<float>(to), Image<float>(to)};
  for_rows(to, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < to.width; ++x) {
        const int first_x = 2 * x, end_x = std::min(first_x + 2, from.width);
        const int first_y = 2 * y, end_y = std::min(first_y + 2, from.height);
        for (int j = first_y; j < end_y; ++j)
          for (int i = first_x; i < end_x; ++i) coarse.primal(x, y) += fine.primal(i, j);
        if (end_x < from.width)
          for (int j = first_y; j < end_y; ++j) coarse.dx(x, y) += 0.5f * fine.dx(end_x - 1, j);
        if (end_y < from.height)
          for (int i = first_x; i < end_x; ++i) coarse.dy(x, y) += 0.5f * fine.dy(i, end_y - 1);
      }
  });
  return coarse;
}

Image<float> inverse_diagonal(const PoissonWeights& weights) {
  const Resolution resolution = weights.primal.resolution();
  Image<float> inverse(resolution);
  for_rows(resolution, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const RowWeights w = weights_of_row(weights, y);
      for (int x = 0; x < resolution.width; ++x) {
        float diagonal = w.primal[x];
        if (w.above) diagonal += w.above[x];
        if (w.below) diagonal += w.below[x];
        if (x > 0) diagonal += w.right[x - 1];
        if (x + 1 < resolution.width) diagonal += w.right[x];
        inverse(x, y) = diagonal > 0 ? 1 / diagonal : 0;
      }
    }
  });
  return inverse;
}

/// Calls body(y, begin of the channel's plane) for all rows of all channels.
template <class Body>
void for_channel_rows(Resolution resolution, const Body& body) {
  for_rows(resolution, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (std::size_t channel = 0; channel < k_channels; ++channel) body(y, channel * resolution.pixels());
  });
}

}  // namespace

void Multigrid::Level::allocate() {
  inverse_diagonal = gradslc::inverse_diagonal(weights());
  const std::size_t values = k_channels * resolution().pixels();
  rhs.resize(values), solution.resize(values), scratch.resize(values);
}

void Multigrid::Level::first_sweep(float damping) {
  for_channel_rows(resolution(), [&](int y, std::size_t plane) {
    const std::size_t first = plane + inverse_diagonal.resolution().index({0, y});
    const float* inverse = &inverse_diagonal(0, y);
    for (std::size_t x = 0; x < columns(); ++x) solution[first + x] = damping * inverse[x] * rhs[first + x];
  });
}

void Multigrid::Level::sweep(float damping) {
  for_channel_rows(resolution(), [&](int y, std::size_t plane) {
    const std::size_t first = plane + inverse_diagonal.resolution().index({0, y});
    const float* inverse = &inverse_diagonal(0, y);
    float* row = &scratch[first];
    residual_of_row(weights(), y, &rhs[plane], &solution[plane], row);
    for (std::size_t x = 0; x < columns(); ++x) row[x] = solution[first + x] + damping * inverse[x] * row[x];
  });
  std::swap(solution, scratch);
}

void Multigrid::Level::restrict_residual_to(Level& coarser) {
  const Resolution to = coarser.resolution();
  for_channel_rows(to, [&](int y, std::size_t coarse_plane) {
    const std::size_t plane = coarse_plane / to.pixels() * resolution().pixels();
    float* out = &coarser.rhs[coarse_plane + to.index({0, y})];
    std::fill_n(out, to.width, 0.0f);
    for (int j = 2 * y; j < std::min(2 * y + 2, resolution().height); ++j) {
      float* row = &scratch[plane + resolution().index({0, j})];
      residual_of_row(weights(), j, &rhs[plane], &solution[plane], row);
      const float* inverse = &inverse_diagonal(0, j);
      for (std::size_t x = 0; x < columns(); ++x) row[x] = inverse[x] > 0 ? row[x] : 0;
      const std::size_t pairs = columns() / 2;
      for (std::size_t x = 0; x < pairs; ++x) out[x] += row[2 * x] + row[2 * x + 1];
      if (columns() % 2 == 1) out[pairs] += row[2 * pairs];
    }
  });
}

void Multigrid::Level::add_from(const Level& coarser) {
  for_channel_rows(resolution(), [&](int y, std::size_t plane) {
    const std::size_t coarse_plane = plane / resolution().pixels() * coarser.resolution().pixels();
    const float* from = &coarser.solution[coarse_plane + coarser.resolution().index({0, y / 2})];
    float* row = &solution[plane + resolution().index({0, y})];
    const float* inverse = &inverse_diagonal(0, y);
    for (std::size_t x = 0; x < columns(); ++x) row[x] += inverse[x] > 0 ? from[x / 2] : 0;
  });
}

Multigrid::Multigrid(const PoissonWeights& weights) {
  levels_.emplace_back().finest = &weights;
  while (levels_.back().resolution().pixels() > k_coarsest_pixels) {
    PoissonWeights coarser = coarsened(levels_.back().weights());
    levels_.emplace_back().coarse = std::move(coarser);
  }
  for (Level& level : levels_) level.allocate();
}

const Multigrid::Field& Multigrid::precondition() {
  cycle(0, true);
  return levels_.front().solution;
}

void Multigrid::cycle(std::size_t number, bool from_zero) {
  Level& level = levels_[number];
  const bool coarsest = number + 1 == levels_.size();
  if (from_zero)
    level.first_sweep(k_damping[0]);
  else
    level.sweep(k_damping[0]);
  level.sweep(k_damping[1]);
  if (coarsest) {
    for (int i = 1; i < k_coarsest_sweeps; ++i) level.sweep(k_damping[0]), level.sweep(k_damping[1]);
    return;
  }
  Level& coarser = levels_[number + 1];
  level.restrict_residual_to(coarser);
  cycle(number + 1, true);
  if (number >= k_first_repeated_level) cycle(number + 1, false);
  level.add_from(coarser);
  level.sweep(k_damping[0]);
  level.sweep(k_damping[1]);
}

}  // namespace gradslc
