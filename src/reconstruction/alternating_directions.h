#pragma once

#include <vector>

#include "reconstruction/preconditioner.h"

namespace gradslc {

/// The matrix p + g_x Lx + g_y Ly of weights that are the same everywhere (Lx, Ly: second differences along rows and
/// columns, mirrored at the border).
struct UniformWeights {
  double primal = 0, dx = 0, dy = 0;
};

/// Solves systems of uniform weights by alternating directions (Peaceman and Rachford 1955, "The numerical solution of
/// parabolic and elliptic differential equations"): with H = p/2 + g_x Lx and V = p/2 + g_y Ly, which commute, for
/// shifts s in turn
///   (s + H) u' = b + (s - V) u,   (s + V) u'' = b + (s - H) u',
/// tridiagonal systems, multiplies the error by (s - h)(s - v) / ((s + h)(s + v)), h and v any eigenvalues. Shifts as
/// by Wachspress (1966, "Iterative solution of elliptic systems", chapter 6), as many as the error that may remain
/// needs: of the order of log(condition).
class AlternatingDirections final : public Preconditioner {
 public:
  /// Of no less than 0; the primal's above 0. `remaining`: the share of any error that apply() may leave, in (0, 1).
  AlternatingDirections(Resolution resolution, const UniformWeights& weights, double remaining);

  void apply(const Field& residual, Field& result, Field& scratch) override;
  std::size_t steps() const { return steps_.size(); }

 private:
  /// A tridiagonal matrix shift + p/2 + g L of one direction, factorised: 1 over the pivots.
  struct Line {
    float off_diagonal = 0;  ///< g: what elements beside the diagonal are, negated
    std::vector<float> inverse_pivots;
  };
  struct Step {
    double shift = 0;
    Line along_x, along_y;
  };
  static Line factorised(int pixels, double diagonal, double weight);
  /// rhs = b + scale u - rhs, or b where there is no u yet; then u = (shift + H)^-1 rhs.
  void solve_rows(const Line& line, float scale, bool first, const Field& b, Field& u, Field& rhs) const;
  void solve_columns(const Line& line, float scale, const Field& b, Field& u, Field& rhs) const;

  Resolution resolution_;
  std::vector<Step> steps_;
};

}  // namespace gradslc
