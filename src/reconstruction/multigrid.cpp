#include "reconstruction/multigrid.h"

#include <algorithm>
#include <utility>

namespace gradslc {
namespace {

constexpr std::size_t k_coarsest_pixels = 16;
constexpr int k_coarsest_sweeps = 8;
/// Of the two Jacobi sweeps before and after a coarser level: roots of the Chebyshev polynomial that is smallest where
/// eigenvalues of D^-1 A, which lie in [0, 2], are not for coarser levels to reduce: in [1/2, 2].
constexpr float k_damping[2] = {1.0f / (1.25f + 0.75f * 0.70710678f), 1.0f / (1.25f - 0.75f * 0.70710678f)};

/// A row of the matrix's weights: of the pixels, and of the gradients that meet there. Where there is no row above or
/// below its weights are 0.
struct RowWeights {
  const float *primal, *right, *above, *below;
};
RowWeights weights_of_row(const PoissonWeights& weights, const std::vector<float>& zeros, int y) {
  const int last = weights.primal.height() - 1;
  return {&weights.primal(0, y), &weights.dx(0, y), y > 0 ? &weights.dy(0, y - 1) : zeros.data(),
          y < last ? &weights.dy(0, y) : zeros.data()};
}

/// row = (rhs - A field) of row y; `rhs` and `field` begin with it, in planes of one channel.
void residual_of_row(const PoissonWeights& weights, const std::vector<float>& zeros, int y, const float* rhs,
                     const float* field, float* __restrict row) {
  const RowWeights w = weights_of_row(weights, zeros, y);
  const int width = weights.primal.width(), last = width - 1;
  const float* above = y > 0 ? field - width : field;
  const float* below = y + 1 < weights.primal.height() ? field + width : field;
  const auto without_sides = [&](int x) {
    return rhs[x] - w.primal[x] * field[x] + w.above[x] * (above[x] - field[x]) + w.below[x] * (below[x] - field[x]);
  };
  for (int x = 1; x < last; ++x)
    row[x] = without_sides(x) + w.right[x - 1] * (field[x - 1] - field[x]) + w.right[x] * (field[x + 1] - field[x]);
  row[0] = without_sides(0);
  if (last == 0) return;
  row[0] += w.right[0] * (field[1] - field[0]);
  row[last] = without_sides(last) + w.right[last - 1] * (field[last - 1] - field[last]);
}

/// The weights of 2 x 2 pixels as one.
PoissonWeights coarsened(const PoissonWeights& fine) {
  const Resolution from = fine.primal.resolution(), to{(from.width + 1) / 2, (from.height + 1) / 2};
  PoissonWeights coarse{Image<float>(to), Image<float>(to), Image<float>(to)};
  for_each_row(to, [&](int y) {
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

Image<float> inverse_diagonal(const PoissonWeights& weights, const std::vector<float>& zeros) {
  const Resolution resolution = weights.primal.resolution();
  Image<float> inverse(resolution);
  for_each_row(resolution, [&](int y) {
    const RowWeights w = weights_of_row(weights, zeros, y);
    for (int x = 0; x < resolution.width; ++x) {
      float diagonal = w.primal[x] + w.above[x] + w.below[x];
      if (x > 0) diagonal += w.right[x - 1];
      if (x + 1 < resolution.width) diagonal += w.right[x];
      inverse(x, y) = diagonal > 0 ? 1 / diagonal : 0;
    }
  });
  return inverse;
}

}  // namespace

Multigrid::Multigrid(const PoissonWeights& weights) {
  levels_.emplace_back().finest = &weights;
  while (levels_.back().resolution().pixels() > k_coarsest_pixels) {
    PoissonWeights coarser = coarsened(levels_.back().weights());
    Level& level = levels_.emplace_back();
    level.coarse = std::move(coarser);
    level.rhs = Field(level.resolution()), level.solution = Field(level.resolution());
    level.scratch = Field(level.resolution());
  }
  for (Level& level : levels_) {
    level.zeros.resize(level.columns());
    level.inverse_diagonal = inverse_diagonal(level.weights(), level.zeros);
  }
}

void Multigrid::apply(const Field& residual, Field& result, Field& scratch) {
  cycle(0, {residual, result, scratch}, true);
}

void Multigrid::cycle(std::size_t number, const Unknowns& of, bool from_zero) {
  const Level& level = levels_[number];
  if (from_zero)
    first_sweep(level, k_damping[0], of);
  else
    sweep(level, k_damping[0], of);
  sweep(level, k_damping[1], of);
  if (number + 1 == levels_.size()) {
    for (int i = 1; i < k_coarsest_sweeps; ++i) sweep(level, k_damping[0], of), sweep(level, k_damping[1], of);
    return;
  }
  Level& coarser = levels_[number + 1];
  const Unknowns coarser_unknowns{coarser.rhs, coarser.solution, coarser.scratch};
  restrict_residual(level, of, coarser);
  cycle(number + 1, coarser_unknowns, true);
  cycle(number + 1, coarser_unknowns, false);
  add_from(coarser, level, of.solution);
  sweep(level, k_damping[0], of);
  sweep(level, k_damping[1], of);
}

void Multigrid::first_sweep(const Level& level, float damping, const Unknowns& of) {
  for_each_channel_row(level.resolution(), [&](int y, std::size_t first) {
    const float *inverse = &level.inverse_diagonal(0, y), *rhs = &of.rhs[first];
    float* __restrict row = &of.solution[first];
    for (std::size_t x = 0; x < level.columns(); ++x) row[x] = damping * inverse[x] * rhs[x];
  });
}

void Multigrid::sweep(const Level& level, float damping, const Unknowns& of) {
  for_each_channel_row(level.resolution(), [&](int y, std::size_t first) {
    const float *inverse = &level.inverse_diagonal(0, y), *before = &of.solution[first];
    float* __restrict row = &of.scratch[first];
    residual_of_row(level.weights(), level.zeros, y, &of.rhs[first], before, row);
    for (std::size_t x = 0; x < level.columns(); ++x) row[x] = before[x] + damping * inverse[x] * row[x];
  });
  std::swap(of.solution, of.scratch);
}

void Multigrid::restrict_residual(const Level& level, const Unknowns& of, Level& coarser) {
  const Resolution from = level.resolution(), to = coarser.resolution();
  const std::size_t columns = level.columns(), pairs = columns / 2;
  for_each_channel_row(to, [&](int y, std::size_t coarse_first) {
    const std::size_t plane = coarse_first / to.pixels() * from.pixels();
    float* __restrict out = &coarser.rhs[coarse_first];
    std::fill_n(out, to.width, 0.0f);
    for (int j = 2 * y; j < std::min(2 * y + 2, from.height); ++j) {
      const std::size_t first = plane + from.index({0, j});
      float* __restrict row = &of.scratch[first];
      residual_of_row(level.weights(), level.zeros, j, &of.rhs[first], &of.solution[first], row);
      const float* inverse = &level.inverse_diagonal(0, j);
      for (std::size_t x = 0; x < columns; ++x) row[x] = inverse[x] > 0 ? row[x] : 0;
      for (std::size_t x = 0; x < pairs; ++x) out[x] += row[2 * x] + row[2 * x + 1];
      if (columns % 2 == 1) out[pairs] += row[2 * pairs];
    }
  });
}

void Multigrid::add_from(const Level& coarser, const Level& level, Field& solution) {
  const Resolution from = coarser.resolution(), to = level.resolution();
  const std::size_t columns = level.columns();
  for_each_channel_row(to, [&](int y, std::size_t first) {
    const float* coarse = &coarser.solution[first / to.pixels() * from.pixels() + from.index({0, y / 2})];
    const float* inverse = &level.inverse_diagonal(0, y);
    float* __restrict row = &solution[first];
    for (std::size_t x = 0; x < columns; ++x) row[x] += inverse[x] > 0 ? coarse[x / 2] : 0;
  });
}

}  // namespace gradslc
