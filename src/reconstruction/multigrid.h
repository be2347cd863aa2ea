#pragma once

#include <vector>

#include "reconstruction/preconditioner.h"

namespace gradslc {

/// A multigrid cycle (Trottenberg, Oosterlee and Schueller 2001, "Multigrid", chapter 2). A coarser problem joins
/// 2 x 2 pixels to one, whose value they all take: primal weights add up, and so do halves of the weights of gradients
/// between them. A half, since centres are twice as far apart; it is also the least for which a coarser solution never
/// overshoots by more than two, and repeated visits (a W-cycle) stay positive.
class Multigrid final : public Preconditioner {
 public:
  /// `weights` must live as long.
  explicit Multigrid(const PoissonWeights& weights);

  void apply(const Field& residual, Field& result, Field& scratch) override;

 private:
  /// The problem with the weights of a level.
  struct Level {
    const PoissonWeights* finest = nullptr;  ///< the problem's
    PoissonWeights coarse;                   ///< unless there is `finest`
    Image<float> inverse_diagonal;           ///< 0 where the diagonal, and so all of its row, is 0
    std::vector<float> zeros;                ///< a row of weights beyond the image
    Field rhs, solution, scratch;            ///< of coarser levels

    const PoissonWeights& weights() const { return finest ? *finest : coarse; }
    Resolution resolution() const { return weights().primal.resolution(); }
    std::size_t columns() const { return static_cast<std::size_t>(resolution().width); }
  };
  struct Unknowns {
    const Field& rhs;
    Field &solution, &scratch;
  };

  /// Jacobi's iteration from 0, or from the solution.
  static void first_sweep(const Level& level, float damping, const Unknowns& of);
  static void sweep(const Level& level, float damping, const Unknowns& of);
  /// The coarser level's rhs: sums of the residual over its pixels.
  static void restrict_residual(const Level& level, const Unknowns& of, Level& coarser);
  static void add_from(const Level& coarser, const Level& level, Field& solution);

  /// Improves a level's solution, or finds one: of its problem for its rhs.
  void cycle(std::size_t level, const Unknowns& of, bool from_zero);

  std::vector<Level> levels_;
};

}  // namespace gradslc
