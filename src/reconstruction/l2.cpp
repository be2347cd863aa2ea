#include "reconstruction/buffers.h"
#include "reconstruction/methods.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// Least squares with weights from counts only (Lehtinen et al. 2013, section 4): linear in the values, hence unbiased.
class L2 final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.real("alpha", alpha_, {1e-3, 100}, "", "weight of the primal against the gradients");
    visitor.real("relative_residual", solver_.relative_residual, {1e-10, 0.1}, "",
                 "residual of the linear system, relative to its right-hand side, at which its solver stops");
  }
  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    const ReconstructionBuffers& buffers = input.combined;
    check_primal_and_gradients(buffers);
    const PoissonWeights weights = count_weights(buffers, alpha_);
    return solve({buffers.primal, buffers.dx, buffers.dy, weights}, solver_);
  }

 private:
  double alpha_ = k_default_alpha;
  SolverOptions solver_;
};

}  // namespace

std::unique_ptr<Reconstruction> make_l2() { return std::make_unique<L2>(); }

}  // namespace gradslc
