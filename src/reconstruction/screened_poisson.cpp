#include "reconstruction/screened_poisson.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "reconstruction/field.h"
#include "reconstruction/preconditioner.h"

namespace gradslc {
namespace {

/// One value per channel.
using Triple = std::array<double, k_field_channels>;

/// Sums over a part of each channel's plane.
struct Sums {
  Triple of = {};
  double& operator[](std::size_t channel) { return of[channel]; }
  Sums& operator+=(const Sums& other) {
    for (std::size_t c = 0; c < k_field_channels; ++c) of[c] += other.of[c];
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
                                for (std::size_t c = 0; c < k_field_channels; ++c) sums[c] += row_sum(y, c);
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

Triple roots(Triple squares) {
  for (double& value : squares) value = std::sqrt(value);
  return squares;
}

double product(float a, float b) { return static_cast<double>(a) * static_cast<double>(b); }

/// The matrix A = diag(w_p) + Dx^T diag(w_x) Dx + Dy^T diag(w_y) Dy, symmetric, never negative definite, never stored.
class NormalMatrix {
 public:
  explicit NormalMatrix(const PoissonWeights& weights)
      : weights_(weights),
        resolution_(weights.primal.resolution()),
        no_weights_(static_cast<std::size_t>(resolution_.width)) {}

  Resolution resolution() const { return resolution_; }

  /// result = A field; returns field . result.
  Triple apply(const Field& field, Field& result) const {
    return sum_over_rows(resolution_, [&](std::size_t y, std::size_t c) {
      const std::size_t first = c * resolution_.pixels() + y * no_weights_.size();
      return apply_row(y, &field[first], &result[first]);
    });
  }

 private:
  double apply_row(std::size_t y, const float* here, float* __restrict out) const {
    const std::size_t width = no_weights_.size(), first = y * width, last = width - 1;
    const bool has_previous = y > 0, has_next = y + 1 < static_cast<std::size_t>(resolution_.height);
    const float *primal = &weights_.primal[first], *right = &weights_.dx[first];
    const float* to_above = has_previous ? &weights_.dy[first - width] : no_weights_.data();
    const float* to_below = has_next ? &weights_.dy[first] : no_weights_.data();
    const float* above = has_previous ? here - width : here;
    const float* below = has_next ? here + width : here;
    const auto without_sides = [&](std::size_t x) {
      return primal[x] * here[x] + to_above[x] * (here[x] - above[x]) + to_below[x] * (here[x] - below[x]);
    };
    for (std::size_t x = 1; x < last; ++x)
      out[x] = without_sides(x) + right[x - 1] * (here[x] - here[x - 1]) + right[x] * (here[x] - here[x + 1]);
    out[0] = without_sides(0);
    if (last > 0) {
      out[0] += right[0] * (here[0] - here[1]);
      out[last] = without_sides(last) + right[last - 1] * (here[last] - here[last - 1]);
    }
    double dot = 0;
#pragma omp simd reduction(+ : dot)
    for (std::size_t x = 0; x < width; ++x) dot += product(here[x], out[x]);
    return dot;
  }

  const PoissonWeights& weights_;
  Resolution resolution_;
  std::vector<float> no_weights_;
};

/// residual = (b - A image) / unit, summed from the terms' own residuals, so that an image that fulfils all terms
/// leaves none; 0 in channels whose unit is 0. Returns the Euclidean norms of b - A image.
Triple compute_residual(const ScreenedPoissonProblem& problem, const PlanarField<double>& image, const Triple& unit,
                        Field& residual) {
  const Resolution resolution = problem.primal.resolution();
  const auto width = static_cast<std::size_t>(resolution.width), height = static_cast<std::size_t>(resolution.height);
  const PoissonWeights& weights = problem.weights;
  return roots(sum_over_rows(resolution, [&](std::size_t y, std::size_t c) {
    const double* plane = &image[c * resolution.pixels()];
    const int channel = static_cast<int>(c);
    const std::size_t first = y * width;
    // What the difference from pixel i to pixel j lacks, times its weight.
    const auto flux = [&](const RgbImage& gradient, const Image<float>& weight, std::size_t i, std::size_t j) {
      return static_cast<double>(weight[i]) * (static_cast<double>(gradient[i][channel]) - (plane[j] - plane[i]));
    };
    std::vector<double> row(width), to_right(width);
    for (std::size_t x = 0; x < width; ++x)
      row[x] = static_cast<double>(weights.primal[first + x]) *
               (static_cast<double>(problem.primal[first + x][channel]) - plane[first + x]);
    for (std::size_t x = 0; x + 1 < width; ++x) to_right[x] = flux(problem.dx, weights.dx, first + x, first + x + 1);
    for (std::size_t x = 0; x + 1 < width; ++x) row[x] -= to_right[x];
    for (std::size_t x = 1; x < width; ++x) row[x] += to_right[x - 1];
    if (y > 0)
      for (std::size_t x = 0; x < width; ++x) row[x] += flux(problem.dy, weights.dy, first - width + x, first + x);
    if (y + 1 < height)
      for (std::size_t x = 0; x < width; ++x) row[x] -= flux(problem.dy, weights.dy, first + x, first + width + x);

    const double scale = unit[c] > 0 ? 1 / unit[c] : 0;
    float* scaled = &residual[c * resolution.pixels() + first];
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t x = 0; x < width; ++x) {
      scaled[x] = static_cast<float>(row[x] * scale);
      sum += row[x] * row[x];
    }
    return sum;
  }));
}

/// Conjugate gradients (Saad 2003, "Iterative Methods for Sparse Linear Systems", 9.2) on three channels at once, each
/// with its own steps.
class ConjugateGradients {
 public:
  /// Plain where there is no preconditioner.
  ConjugateGradients(const PoissonWeights& weights, Preconditioner* preconditioner)
      : matrix_(weights),
        preconditioner_(preconditioner),
        direction_(matrix_.resolution()),
        product_(matrix_.resolution()) {
    if (preconditioner) preconditioned_ = Field(matrix_.resolution());
  }

  /// Improves `solution`, whose residual is `residual` times `unit` per channel, until the residual's norms, as the
  /// recurrence has them, are at most `target` times unit. Returns the iterations taken, at most `max_iterations`.
  int improve(PlanarField<double>& solution, Field& residual, const Triple& unit, double target, int max_iterations) {
    const Resolution resolution = matrix_.resolution();
    Triple norms = roots(
        sum_over_pixels(resolution, [&](std::size_t i, std::size_t) { return product(residual[i], residual[i]); }));
    Triple previous = {};  // residual . M^-1 residual
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (*std::max_element(norms.begin(), norms.end()) <= target) return iteration;
      if (preconditioner_) preconditioner_->apply(residual, preconditioned_, product_);
      const Field& step = preconditioner_ ? preconditioned_ : residual;
      const Triple dots =
          sum_over_pixels(resolution, [&](std::size_t i, std::size_t) { return product(residual[i], step[i]); });
      Triple beta = {}, length = {};
      for (std::size_t c = 0; c < k_field_channels; ++c)
        if (previous[c] > 0) beta[c] = dots[c] / previous[c];
      set_direction(step, iteration > 0 ? &beta : nullptr);
      previous = dots;
      const Triple curvature = matrix_.apply(direction_, product_);
      bool moves = false;
      for (std::size_t c = 0; c < k_field_channels; ++c) {
        if (!(curvature[c] > 0)) continue;  // rounding is all that is left of the direction
        length[c] = previous[c] / curvature[c];
        moves = true;
      }
      if (!moves) return iteration;
      norms = roots(sum_over_pixels(resolution, [&](std::size_t i, std::size_t c) {
        solution[i] += length[c] * unit[c] * static_cast<double>(direction_[i]);
        residual[i] -= static_cast<float>(length[c]) * product_[i];
        return product(residual[i], residual[i]);
      }));
    }
    return max_iterations;
  }

 private:
  /// direction = step + beta direction; without `beta`, step.
  void set_direction(const Field& step, const Triple* beta) {
    const Resolution resolution = matrix_.resolution();
    for_each_channel_row(resolution, [&](int, std::size_t first) {
      const float *from = &step[first], factor = beta ? static_cast<float>((*beta)[first / resolution.pixels()]) : 0;
      float* __restrict row = &direction_[first];
      const auto width = static_cast<std::size_t>(resolution.width);
      if (!beta)
        std::copy_n(from, width, row);
      else
        for (std::size_t x = 0; x < width; ++x) row[x] = from[x] + factor * row[x];
    });
  }

  NormalMatrix matrix_;
  Preconditioner* preconditioner_;
  Field direction_, product_, preconditioned_;
};

/// The start that is given, or the primal, and 0 where it has no weight, or in channels that are not `used`.
void set_start(const ScreenedPoissonProblem& problem, const Triple& used, PlanarField<double>& image) {
  const RgbImage& start = problem.start ? *problem.start : problem.primal;
  const Resolution resolution = start.resolution();
  for_each_channel_row(resolution, [&](int y, std::size_t first) {
    const std::size_t channel = first / resolution.pixels(), pixel = resolution.index({0, y});
    for (std::size_t x = 0; x < static_cast<std::size_t>(resolution.width); ++x) {
      const bool known = used[channel] > 0 && (problem.start || problem.weights.primal[pixel + x] > 0);
      image[first + x] = known ? static_cast<double>(start[pixel + x][static_cast<int>(channel)]) : 0;
    }
  });
}

RgbImage image_of(const PlanarField<double>& field, Resolution resolution) {
  RgbImage image(resolution);
  const std::size_t pixels = image.size();
  for_each_row(resolution, [&](int y) {
    for (int x = 0; x < resolution.width; ++x) {
      const std::size_t i = resolution.index({x, y});
      image[i] = Rgb(static_cast<float>(field[i]), static_cast<float>(field[pixels + i]),
                     static_cast<float>(field[2 * pixels + i]));
    }
  });
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
  for (std::size_t c = 0; c < k_field_channels; ++c)
    if (b[c] > 0) largest = std::max(largest, residual[c] / b[c]);
  return largest;
}

}  // namespace

ReconstructionResult solve(const ScreenedPoissonProblem& given, const SolverOptions& options) {
  const std::optional<PoissonWeights> scaled = scaled_weights(given.weights);
  const ScreenedPoissonProblem problem{given.primal, given.dx, given.dy, scaled ? *scaled : given.weights, given.start};
  const Resolution resolution = problem.primal.resolution();
  PlanarField<double> image(resolution);
  Field residual(resolution);
  set_start(problem, {}, image);
  const Triple b = compute_residual(problem, image, {}, residual);
  Triple unit = b;  // residuals have norms near 1 in it, pixels' a size that floats have room around
  const double pixels_root = std::sqrt(static_cast<double>(resolution.pixels()));
  for (double& value : unit) value /= pixels_root;

  ReconstructionStatistics statistics;
  if (largest_ratio(b, b) > 0) {
    set_start(problem, b, image);
    const std::unique_ptr<Preconditioner> preconditioner =
        options.preconditioned ? make_preconditioner(problem.weights) : nullptr;
    ConjugateGradients gradients(problem.weights, preconditioner.get());
    double previous = std::numeric_limits<double>::infinity();
    while (true) {  // the recurrence drifts away from the true residual: begin again from there, as long as it helps
      statistics.relative_residual = largest_ratio(compute_residual(problem, image, unit, residual), b);
      statistics.converged = statistics.relative_residual <= options.relative_residual;
      if (statistics.converged || statistics.iterations >= options.max_iterations ||
          statistics.relative_residual > 0.5 * previous)
        break;
      previous = statistics.relative_residual;
      statistics.iterations += gradients.improve(image, residual, unit, options.relative_residual * pixels_root,
                                                 options.max_iterations - statistics.iterations);
    }
  }
  return {.image = image_of(image, resolution), .statistics = statistics};
}

}  // namespace gradslc
