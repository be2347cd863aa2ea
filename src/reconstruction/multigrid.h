#pragma once

#include <cstddef>
#include <vector>

#include "reconstruction/screened_poisson.h"

namespace gradslc {

/// An approximate inverse of the screened Poisson problem's matrix, symmetric and positive: a multigrid cycle
/// (Trottenberg, Oosterlee and Schueller 2001, "Multigrid", chapter 2) as a preconditioner. A coarser problem joins
/// 2 x 2 pixels to one, whose value they all take: primal weights add up, and so do halves of the weights of gradients
/// between them. A half, since centres are twice as far apart; it is also the least for which a coarser solution never
/// overshoots by more than two, and repeated visits (a W-cycle) stay positive.
/// In float, and on three channels at once: fields are planes, one channel after the other, row-major.
class Multigrid {
 public:
  using Field = std::vector<float>;

  /// `weights` must live as long.
  explicit Multigrid(const PoissonWeights& weights);

  /// What precondition() takes; of a size near 1.
  Field& right_hand_side() { return levels_.front().rhs; }
  /// M^-1 times right_hand_side().
  const Field& precondition();

 private:
  struct Level {
    const PoissonWeights* finest = nullptr;  ///< the problem's
    PoissonWeights coarse;                   ///< unless there is `finest`
    Image<float> inverse_diagonal;           ///< 0 where the diagonal, and so all of its row, is 0
    Field rhs, solution, scratch;

    const PoissonWeights& weights() const { return finest ? *finest : coarse; }
    Resolution resolution() const { return weights().primal.resolution(); }
    std::size_t columns() const { return static_cast<std::size_t>(resolution().width); }
    void allocate();
    /// Jacobi's iteration from 0, or from `solution`.
    void first_sweep(float damping);
    void sweep(float damping);
    /// The coarser level's rhs: sums of the residual over its pixels.
    void restrict_residual_to(Level& coarser);
    void add_from(const Level& coarser);
  };

  /// Improves a level's `solution`, or finds one: of its problem for its rhs.
  void cycle(std::size_t level, bool from_zero);

  std::vector<Level> levels_;
};

}  // namespace gradslc
