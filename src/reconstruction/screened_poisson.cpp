#include "reconstruction/screened_poisson.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/parallel.h"

namespace gradslc {
namespace {

/// One channel, row-major. Double: a small weight of the primal makes the matrix too ill-conditioned for float.
using Field = std::vector<double>;

constexpr std::size_t k_pixels_per_chunk = 32768;

std::size_t rows_per_chunk(Resolution resolution) {
  return std::max<std::size_t>(1, k_pixels_per_chunk / static_cast<std::size_t>(resolution.width));
}

/// Sum of row_sum(y) over all rows in a fixed order, on all threads.
template <class RowSum>
double sum_over_rows(Resolution resolution, const RowSum& row_sum) {
  return parallel_sum<double>(static_cast<std::size_t>(resolution.height), rows_per_chunk(resolution),
                              [&](std::size_t begin, std::size_t end) {
                                double sum = 0;
                                for (std::size_t y = begin; y < end; ++y) sum += row_sum(y);
                                return sum;
                              });
}

/// Two sums over the same pixels.
struct Dots {
  double residual = 0, preconditioned = 0;
  Dots& operator+=(const Dots& other) {
    residual += other.residual;
    preconditioned += other.preconditioned;
    return *this;
  }
};

/// The matrix A = diag(w_p) + Dx^T diag(w_x) Dx + Dy^T diag(w_y) Dy, symmetric, never negative definite, never stored.
class NormalMatrix {
 public:
  explicit NormalMatrix(const PoissonWeights& weights)
      : weights_(weights),
        resolution_(weights.primal.resolution()),
        no_weights_(static_cast<std::size_t>(resolution_.width)) {}

  Resolution resolution() const { return resolution_; }

  /// product = A field; returns field . product.
  double apply(const Field& field, Field& product) const {
    return sum_over_rows(resolution_, [&](std::size_t y) { return apply_row(y, field, product); });
  }

  /// 1 / A(i,i); 0 where the diagonal, and so all of row i, is 0.
  Field inverse_diagonal() const {
    Field inverse(resolution_.pixels());
    const std::size_t width = no_weights_.size();
    parallel_for(static_cast<std::size_t>(resolution_.height), rows_per_chunk(resolution_),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t y = begin; y < end; ++y) {
                     const Row row = weights_of_row(y);
                     for (std::size_t x = 0; x < width; ++x) {
                       double diagonal = static_cast<double>(row.primal[x]) + row.above[x] + row.below[x];
                       if (x > 0) diagonal += row.right[x - 1];
                       if (x + 1 < width) diagonal += row.right[x];
                       inverse[y * width + x] = diagonal > 0 ? 1 / diagonal : 0;
                     }
                   }
                 });
    return inverse;
  }

 private:
  /// Weights that meet in a row; `above` and `below` are 0 at the image's border.
  struct Row {
    const float *primal, *right, *above, *below;
  };
  Row weights_of_row(std::size_t y) const {
    const std::size_t width = no_weights_.size(), first = y * width;
    const bool has_next = y + 1 < static_cast<std::size_t>(resolution_.height);
    return {&weights_.primal[first], &weights_.dx[first], y > 0 ? &weights_.dy[first - width] : no_weights_.data(),
            has_next ? &weights_.dy[first] : no_weights_.data()};
  }

  double apply_row(std::size_t y, const Field& field, Field& product) const {
    const std::size_t width = no_weights_.size(), first = y * width;
    const Row row = weights_of_row(y);
    const double* here = &field[first];
    const double* above = y > 0 ? here - width : here;
    const double* below = y + 1 < static_cast<std::size_t>(resolution_.height) ? here + width : here;
    double* out = &product[first];
    for (std::size_t x = 0; x < width; ++x)
      out[x] = row.primal[x] * here[x] + row.above[x] * (here[x] - above[x]) + row.below[x] * (here[x] - below[x]);
    for (std::size_t x = 1; x < width; ++x) out[x] += row.right[x - 1] * (here[x] - here[x - 1]);
    for (std::size_t x = 0; x + 1 < width; ++x) out[x] += row.right[x] * (here[x] - here[x + 1]);
    double dot = 0;
#pragma omp simd reduction(+ : dot)
    for (std::size_t x = 0; x < width; ++x) dot += here[x] * out[x];
    return dot;
  }

  const PoissonWeights& weights_;
  Resolution resolution_;
  std::vector<float> no_weights_;
};

/// residual = b - A image of one channel, summed from the terms' own residuals, so that an image that fulfils all terms
/// leaves none; returns its Euclidean norm.
double compute_residual(const ScreenedPoissonProblem& problem, int channel, const Field& image, Field& residual) {
  const Resolution resolution = problem.primal.resolution();
  const auto width = static_cast<std::size_t>(resolution.width), height = static_cast<std::size_t>(resolution.height);
  const PoissonWeights& weights = problem.weights;
  // What the difference from pixel i to pixel j lacks, times its weight.
  const auto flux = [&](const RgbImage& gradient, const Image<float>& weight, std::size_t i, std::size_t j) {
    return static_cast<double>(weight[i]) * (static_cast<double>(gradient[i][channel]) - (image[j] - image[i]));
  };
  const double square_sum = sum_over_rows(resolution, [&](std::size_t y) {
    double row_sum = 0;
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      double value =
          static_cast<double>(weights.primal[i]) * (static_cast<double>(problem.primal[i][channel]) - image[i]);
      if (x > 0) value += flux(problem.dx, weights.dx, i - 1, i);
      if (x + 1 < width) value -= flux(problem.dx, weights.dx, i, i + 1);
      if (y > 0) value += flux(problem.dy, weights.dy, i - width, i);
      if (y + 1 < height) value -= flux(problem.dy, weights.dy, i, i + width);
      residual[i] = value;
      row_sum += value * value;
    }
    return row_sum;
  });
  return std::sqrt(square_sum);
}

/// Conjugate gradients with Jacobi's preconditioner (Saad 2003, "Iterative Methods for Sparse Linear Systems", 9.2).
class ConjugateGradients {
 public:
  explicit ConjugateGradients(const NormalMatrix& matrix)
      : matrix_(matrix),
        inverse_diagonal_(matrix.inverse_diagonal()),
        direction_(matrix.resolution().pixels()),
        product_(matrix.resolution().pixels()) {}

  /// Improves `solution`, whose residual is `residual`, until the residual's norm, as the recurrence has it, is at most
  /// `target`. Returns the iterations taken, at most `max_iterations`.
  int improve(Field& solution, Field& residual, double target, int max_iterations) {
    Dots dots = precondition_and_measure(residual);
    std::fill(direction_.begin(), direction_.end(), 0.0);
    double beta = 0;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (std::sqrt(dots.residual) <= target) return iteration;
      update_direction(residual, beta);
      const double curvature = matrix_.apply(direction_, product_);
      if (!(curvature > 0)) return iteration;  // rounding is all that is left of the direction
      const double previous = dots.preconditioned;
      dots = step(solution, residual, previous / curvature);
      beta = dots.preconditioned / previous;
    }
    return max_iterations;
  }

 private:
  template <class Body>
  Dots sum_dots(const Body& body) const {
    return parallel_sum<Dots>(direction_.size(), k_pixels_per_chunk, body);
  }

  Dots precondition_and_measure(const Field& residual) const {
    return sum_dots([&](std::size_t begin, std::size_t end) {
      double square = 0, preconditioned = 0;
#pragma omp simd reduction(+ : square, preconditioned)
      for (std::size_t i = begin; i < end; ++i) {
        square += residual[i] * residual[i];
        preconditioned += residual[i] * residual[i] * inverse_diagonal_[i];
      }
      return Dots{square, preconditioned};
    });
  }

  void update_direction(const Field& residual, double beta) {
    parallel_for(direction_.size(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        direction_[i] = inverse_diagonal_[i] * residual[i] + beta * direction_[i];
    });
  }

  Dots step(Field& solution, Field& residual, double length) const {
    return sum_dots([&](std::size_t begin, std::size_t end) {
      double square = 0, preconditioned = 0;
#pragma omp simd reduction(+ : square, preconditioned)
      for (std::size_t i = begin; i < end; ++i) {
        solution[i] += length * direction_[i];
        residual[i] -= length * product_[i];
        square += residual[i] * residual[i];
        preconditioned += residual[i] * residual[i] * inverse_diagonal_[i];
      }
      return Dots{square, preconditioned};
    });
  }

  const NormalMatrix& matrix_;
  Field inverse_diagonal_, direction_, product_;
};

/// The primal, which is near the solution; 0 where it has no weight.
void fill_start(const ScreenedPoissonProblem& problem, int channel, Field& image) {
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = problem.weights.primal[i] > 0 ? static_cast<double>(problem.primal[i][channel]) : 0.0;
}

/// Leaves the solution of one channel in `image`; `residual` is scratch.
ReconstructionStatistics solve_channel(const ScreenedPoissonProblem& problem, int channel, const SolverOptions& options,
                                       ConjugateGradients& gradients, Field& image, Field& residual) {
  std::fill(image.begin(), image.end(), 0.0);
  const double norm = compute_residual(problem, channel, image, residual);  // of b: the image is zero
  if (norm == 0) return {};
  const double target = options.relative_residual * norm;
  fill_start(problem, channel, image);
  ReconstructionStatistics statistics;
  double previous = std::numeric_limits<double>::infinity();
  while (true) {  // the recurrence drifts away from the true residual: begin again from there, as long as it helps
    const double current = compute_residual(problem, channel, image, residual);
    statistics.relative_residual = current / norm;
    statistics.converged = current <= target;
    if (statistics.converged || statistics.iterations >= options.max_iterations || current > 0.5 * previous)
      return statistics;
    previous = current;
    statistics.iterations += gradients.improve(image, residual, target, options.max_iterations - statistics.iterations);
  }
}

void set_channel(RgbImage& image, int channel, const Field& values) {
  float Rgb::*const member = channel == 0 ? &Rgb::r : channel == 1 ? &Rgb::g : &Rgb::b;
  for (std::size_t i = 0; i < values.size(); ++i) image[i].*member = static_cast<float>(values[i]);
}

}  // namespace

ReconstructionResult solve(const ScreenedPoissonProblem& problem, const SolverOptions& options) {
  const Resolution resolution = problem.primal.resolution();
  const NormalMatrix matrix(problem.weights);
  ConjugateGradients gradients(matrix);
  Field image(resolution.pixels()), residual(resolution.pixels());
  ReconstructionResult result{.image = RgbImage(resolution), .statistics = {}};
  for (int channel = 0; channel < 3; ++channel) {
    const ReconstructionStatistics found = solve_channel(problem, channel, options, gradients, image, residual);
    set_channel(result.image, channel, image);
    result.statistics.iterations = std::max(result.statistics.iterations, found.iterations);
    result.statistics.relative_residual = std::max(result.statistics.relative_residual, found.relative_residual);
    result.statistics.converged = result.statistics.converged && found.converged;
  }
  return result;
}

}  // namespace gradslc
