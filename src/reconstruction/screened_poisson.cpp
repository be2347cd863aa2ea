#include "reconstruction/screened_poisson.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "reconstruction/multigrid.h"

namespace gradslc {
namespace {

constexpr std::size_t k_channels = 3;
/// One value per channel.
using Triple = std::array<double, k_channels>;
/// Planes, one channel after the other, row-major. Double: a small weight of the primal makes the matrix too
/// ill-conditioned for float.
using Field = std::vector<double>;

constexpr std::size_t k_pixels_per_chunk = 16384;

std::size_t rows_per_chunk(Resolution resolution) {
  return std::max<std::size_t>(1, k_pixels_per_chunk / static_cast<std::size_t>(resolution.width));
}

/// Sums over a part of each channel's plane.
struct Sums {
  Triple of = {};
  double& operator[](std::size_t channel) { return of[channel]; }
  Sums& operator+=(const Sums& other) {
    for (std::size_t c = 0; c < k_channels; ++c) of[c] += other.of[c];
    return *this;
  }
};

/// Sum of row_sum(y, channel) over all rows in a fixed order, on all threads.
template <class RowSum>
Triple sum_over_rows(Resolution resolution, const RowSum& row_sum) {
  const auto rows = static_cast<std::size_t>(resolution.height);
  return parallel_sum<Sums>(rows, rows_per_chunk(resolution),
                            [&](std::size_t begin, std::size_t end) {
                              Sums sums;
                              for (std::size_t y = begin; y < end; ++y)
                                for (std::size_t c = 0; c < k_channels; ++c) sums[c] += row_sum(y, c);
                              return sums;
                            })
      .of;
}

/// Sum of value(i, channel) over all pixels, i in the field, in a fixed order, on all threads.
template <class Value>
Triple sum_over_pixels(Resolution resolution, const Value& value) {
  const std::size_t width = static_cast<std::size_t>(resolution.width), plane = resolution.pixels();
  return sum_over_rows(resolution, [&](std::size_t y, std::size_t c) {
    const std::size_t first = c * plane + y * width;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = first; i < first + width; ++i) sum += value(i, c);
    return sum;
  });
}

/// The matrix A = diag(w_p) + Dx^T diag(w_x) Dx + Dy^T diag(w_y) Dy, symmetric, never negative definite, never stored.
class NormalMatrix {
 public:
  explicit NormalMatrix(const PoissonWeights& weights)
      : weights_(weights),
        resolution_(weights.primal.resolution()),
        no_weights_(static_cast<std::size_t>(resolution_.width)) {}

  Resolution resolution() const { return resolution_; }

  /// product = A field; returns field . product.
  Triple apply(const Field& field, Field& product) const {
    return sum_over_rows(resolution_, [&](std::size_t y, std::size_t c) {
      const std::size_t plane = c * resolution_.pixels();
      return apply_row(y, &field[plane], &product[plane]);
    });
  }

 private:
  double apply_row(std::size_t y, const double* field, double* product) const {
    const std::size_t width = no_weights_.size(), first = y * width;
    const bool has_previous = y > 0, has_next = y + 1 < static_cast<std::size_t>(resolution_.height);
    const float *primal = &weights_.primal[first], *right = &weights_.dx[first];
    const float* to_above = has_previous ? &weights_.dy[first - width] : no_weights_.data();
    const float* to_below = has_next ? &weights_.dy[first] : no_weights_.data();
    const double* here = field + first;
    const double* above = has_previous ? here - width : here;
    const double* below = has_next ? here + width : here;
    double* out = product + first;
    for (std::size_t x = 0; x < width; ++x)
      out[x] = primal[x] * here[x] + to_above[x] * (here[x] - above[x]) + to_below[x] * (here[x] - below[x]);
    for (std::size_t x = 1; x < width; ++x) out[x] += right[x - 1] * (here[x] - here[x - 1]);
    for (std::size_t x = 0; x + 1 < width; ++x) out[x] += right[x] * (here[x] - here[x + 1]);
    double dot = 0;
#pragma omp simd reduction(+ : dot)
    for (std::size_t x = 0; x < width; ++x) dot += here[x] * out[x];
    return dot;
  }

  const PoissonWeights& weights_;
  Resolution resolution_;
  std::vector<float> no_weights_;
};

Triple roots(Triple squares) {
  for (double& value : squares) value = std::sqrt(value);
  return squares;
}

/// residual = b - A image, summed from the terms' own residuals, so that an image that fulfils all terms leaves none;
/// returns its Euclidean norms.
Triple compute_residual(const ScreenedPoissonProblem& problem, const Field& image, Field& residual) {
  const Resolution resolution = problem.primal.resolution();
  const auto width = static_cast<std::size_t>(resolution.width), height = static_cast<std::size_t>(resolution.height);
  const PoissonWeights& weights = problem.weights;
  return roots(sum_over_rows(resolution, [&](std::size_t y, std::size_t c) {
    const double* plane = &image[c * resolution.pixels()];
    const int channel = static_cast<int>(c);
    // What the difference from pixel i to pixel j lacks, times its weight.
    const auto flux = [&](const RgbImage& gradient, const Image<float>& weight, std::size_t i, std::size_t j) {
      return static_cast<double>(weight[i]) * (static_cast<double>(gradient[i][channel]) - (plane[j] - plane[i]));
    };
    double row_sum = 0;
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      double value =
          static_cast<double>(weights.primal[i]) * (static_cast<double>(problem.primal[i][channel]) - plane[i]);
      if (x > 0) value += flux(problem.dx, weights.dx, i - 1, i);
      if (x + 1 < width) value -= flux(problem.dx, weights.dx, i, i + 1);
      if (y > 0) value += flux(problem.dy, weights.dy, i - width, i);
      if (y + 1 < height) value -= flux(problem.dy, weights.dy, i, i + width);
      residual[c * resolution.pixels() + i] = value;
      row_sum += value * value;
    }
    return row_sum;
  }));
}

/// Conjugate gradients (Saad 2003, "Iterative Methods for Sparse Linear Systems", 9.2), preconditioned by a multigrid
/// cycle, on three channels at once, each with its own steps.
class ConjugateGradients {
 public:
  explicit ConjugateGradients(const PoissonWeights& weights)
      : matrix_(weights),
        multigrid_(weights),
        direction_(k_channels * weights.primal.size()),
        product_(direction_.size()) {}

  /// Improves `solution`, whose residual is `residual` with norms `norms`, until the residual's norms, as the
  /// recurrence has them, are at most `targets`. Returns the iterations taken, at most `max_iterations`.
  int improve(Field& solution, Field& residual, Triple norms, const Triple& targets, int max_iterations) {
    const Resolution resolution = matrix_.resolution();
    Triple previous = {};  // residual . M^-1 residual
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (all_within(norms, targets)) return iteration;
      const std::vector<float>& preconditioned = precondition(residual, norms);
      const Triple dots = sum_over_pixels(
          resolution, [&](std::size_t i, std::size_t) { return residual[i] * static_cast<double>(preconditioned[i]); });
      Triple beta = {}, length = {};
      for (std::size_t c = 0; c < k_channels; ++c)
        if (previous[c] > 0) beta[c] = norms[c] * dots[c] / previous[c];
      sum_over_pixels(resolution, [&](std::size_t i, std::size_t c) {
        return direction_[i] = norms[c] * static_cast<double>(preconditioned[i]) + beta[c] * direction_[i];
      });
      const Triple curvature = matrix_.apply(direction_, product_);
      bool moves = false;
      for (std::size_t c = 0; c < k_channels; ++c) {
        previous[c] = norms[c] * dots[c];
        if (!(curvature[c] > 0)) continue;  // rounding is all that is left of the direction
        length[c] = previous[c] / curvature[c];
        moves = true;
      }
      if (!moves) return iteration;
      norms = roots(sum_over_pixels(resolution, [&](std::size_t i, std::size_t c) {
        solution[i] += length[c] * direction_[i];
        residual[i] -= length[c] * product_[i];
        return residual[i] * residual[i];
      }));
    }
    return max_iterations;
  }

 private:
  static bool all_within(const Triple& norms, const Triple& targets) {
    for (std::size_t c = 0; c < k_channels; ++c)
      if (norms[c] > targets[c]) return false;
    return true;
  }

  /// M^-1 residual / norms.
  const std::vector<float>& precondition(const Field& residual, const Triple& norms) {
    std::vector<float>& rhs = multigrid_.right_hand_side();
    Triple scale = {};
    for (std::size_t c = 0; c < k_channels; ++c)
      if (norms[c] > 0) scale[c] = 1 / norms[c];
    sum_over_pixels(matrix_.resolution(), [&](std::size_t i, std::size_t c) {
      rhs[i] = static_cast<float>(scale[c] * residual[i]);
      return 0.0;
    });
    return multigrid_.precondition();
  }

  NormalMatrix matrix_;
  Multigrid multigrid_;
  Field direction_, product_;
};

/// The start that is given, or the primal, and 0 where it has no weight.
Field start_of(const ScreenedPoissonProblem& problem) {
  const std::size_t pixels = problem.primal.size();
  const RgbImage& start = problem.start ? *problem.start : problem.primal;
  Field image(k_channels * pixels);
  for (std::size_t c = 0; c < k_channels; ++c)
    for (std::size_t i = 0; i < pixels; ++i)
      if (problem.start || problem.weights.primal[i] > 0)
        image[c * pixels + i] = static_cast<double>(start[i][static_cast<int>(c)]);
  return image;
}

RgbImage image_of(const Field& field, Resolution resolution) {
  RgbImage image(resolution);
  const std::size_t pixels = image.size();
  for (std::size_t i = 0; i < pixels; ++i)
    image[i] = Rgb(static_cast<float>(field[i]), static_cast<float>(field[pixels + i]),
                   static_cast<float>(field[2 * pixels + i]));
  return image;
}

/// The weights times a power of two that makes the largest about 1, where floats have room to both sides; nothing where
/// that is not needed.
std::optional<PoissonWeights> scaled_weights(const PoissonWeights& weights) {
  constexpr int k_room = 32;
  float largest = 0;
  for (const Image<float>* term : {&weights.primal, &weights.dx, &weights.dy})
    for (const float weight : *term) largest = std::max(largest, weight);
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  if (std::abs(exponent) <= k_room) return std::nullopt;
  PoissonWeights scaled = weights;
  for (Image<float>* term : {&scaled.primal, &scaled.dx, &scaled.dy})
    for (float& weight : *term) weight = std::ldexp(weight, -exponent);
  return scaled;
}

/// The largest of |residual| / |b|; 0 for channels whose b is 0.
double largest_ratio(const Triple& residual, const Triple& b) {
  double largest = 0;
  for (std::size_t c = 0; c < k_channels; ++c)
    if (b[c] > 0) largest = std::max(largest, residual[c] / b[c]);
  return largest;
}

}  // namespace

ReconstructionResult solve(const ScreenedPoissonProblem& given, const SolverOptions& options) {
  const std::optional<PoissonWeights> scaled = scaled_weights(given.weights);
  const ScreenedPoissonProblem problem{given.primal, given.dx, given.dy, scaled ? *scaled : given.weights, given.start};
  const Resolution resolution = problem.primal.resolution();
  Field image(k_channels * resolution.pixels()), residual(image.size());
  const Triple b = compute_residual(problem, image, residual);
  Triple targets = b;
  for (double& target : targets) target *= options.relative_residual;

  ReconstructionStatistics statistics;
  if (largest_ratio(b, b) > 0) {
    image = start_of(problem);
    for (std::size_t c = 0; c < k_channels; ++c)
      if (b[c] == 0)
        std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(c * resolution.pixels()), resolution.pixels(), 0.0);
    ConjugateGradients gradients(problem.weights);
    double previous = std::numeric_limits<double>::infinity();
    while (true) {  // the recurrence drifts away from the true residual: begin again from there, as long as it helps
      const Triple norms = compute_residual(problem, image, residual);
      statistics.relative_residual = largest_ratio(norms, b);
      statistics.converged = statistics.relative_residual <= options.relative_residual;
      if (statistics.converged || statistics.iterations >= options.max_iterations ||
          statistics.relative_residual > 0.5 * previous)
        break;
      previous = statistics.relative_residual;
      statistics.iterations +=
          gradients.improve(image, residual, norms, targets, options.max_iterations - statistics.iterations);
    }
  }
  return {.image = image_of(image, resolution), .statistics = statistics};
}

}  // namespace gradslc
