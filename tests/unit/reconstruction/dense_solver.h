#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "reconstruction/screened_poisson.h"

namespace gradslc {

/// The normal equations of one channel as a dense matrix, put together term by term from the definition of what is
/// minimised: a term w (g . I - v)^2 adds w g g^T to the matrix and w v g to the right-hand side.
class DenseSystem {
 public:
  DenseSystem(const ScreenedPoissonProblem& problem, int channel)
      : n_(problem.primal.size()), matrix_(n_ * n_), right_side_(n_) {
    const int width = problem.primal.width(), height = problem.primal.height();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        add_term(i, i, 0, problem.weights.primal[i], problem.primal[i][channel]);
        if (x + 1 < width) add_term(i + 1, i, -1, problem.weights.dx[i], problem.dx[i][channel]);
        if (y + 1 < height)
          add_term(i + static_cast<std::size_t>(width), i, -1, problem.weights.dy[i], problem.dy[i][channel]);
      }
  }

  /// |b - A x| / |b|.
  double relative_residual(const std::vector<double>& x) const {
    double residual = 0, norm = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      double r = right_side_[i];
      for (std::size_t j = 0; j < n_; ++j) r -= matrix_[i * n_ + j] * x[j];
      residual += r * r;
      norm += right_side_[i] * right_side_[i];
    }
    return std::sqrt(residual / norm);
  }

  /// By Gaussian elimination with partial pivoting; the matrix must not be singular.
  std::vector<double> solve() const {
    std::vector<double> a = matrix_, x = right_side_;
    for (std::size_t k = 0; k < n_; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k; i < n_; ++i)
        if (std::abs(a[i * n_ + k]) > std::abs(a[pivot * n_ + k])) pivot = i;
      for (std::size_t j = 0; j < n_; ++j) std::swap(a[k * n_ + j], a[pivot * n_ + j]);
      std::swap(x[k], x[pivot]);
      for (std::size_t i = k + 1; i < n_; ++i) {
        const double factor = a[i * n_ + k] / a[k * n_ + k];
        for (std::size_t j = k; j < n_; ++j) a[i * n_ + j] -= factor * a[k * n_ + j];
        x[i] -= factor * x[k];
      }
    }
    for (std::size_t k = n_; k-- > 0;) {
      for (std::size_t j = k + 1; j < n_; ++j) x[k] -= a[k * n_ + j] * x[j];
      x[k] /= a[k * n_ + k];
    }
    return x;
  }

 private:
  /// weight (I_i + sign_j I_j - value)^2; sign_j = 0: only I_i.
  void add_term(std::size_t i, std::size_t j, double sign_j, float weight, float value) {
    const double w = static_cast<double>(weight);
    matrix_[i * n_ + i] += w;
    right_side_[i] += w * static_cast<double>(value);
    if (sign_j == 0) return;
    matrix_[j * n_ + j] += w;
    matrix_[i * n_ + j] += sign_j * w;
    matrix_[j * n_ + i] += sign_j * w;
    right_side_[j] += sign_j * w * static_cast<double>(value);
  }

  std::size_t n_;
  std::vector<double> matrix_, right_side_;
};

}  // namespace gradslc
