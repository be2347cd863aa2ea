#include "reconstruction/buffers.h"
#include "reconstruction/methods.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// Least squares with inverse variances as weights (DESIGN 7). A weight that is measured from the values that it weighs
/// is small where a bright outlier was sampled, so outliers are rejected and the image darkens slightly: biased. With
/// `cross` each half is solved with the other half's variances, which know nothing of its values, and the two images
/// are averaged by counts.
class Weighted final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.real("lambda", options_.lambda, {1e-6, 1e4}, "",
                 "weight of the primal against the gradients; 1 takes the variances at their word");
    visitor.integer("radius", options_.radius, {0, 32}, "pixels",
                    "a variance counts as no less than half the mean over (2 radius + 1)^2 pixels");
    visitor.boolean("cross", cross_,
                    "weights of each half of the passes from the other half (no bias seen; needs some 20 passes); "
                    "false: from the same passes, which rejects outliers and darkens slightly (biased)");
    visitor.real("relative_residual", solver_.relative_residual, {1e-10, 0.1}, "",
                 "residual of the linear system, relative to its right-hand side, at which its solver stops");
  }

  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    if (!cross_) {
      check_primal_and_gradients(input.combined);
      return solve_weighted(input.combined, input.combined, options_, solver_);
    }
    check_halves(input);
    const ReconstructionResult a = solve_weighted(input.halves[0], input.halves[1], options_, solver_);
    const ReconstructionResult b = solve_weighted(input.halves[1], input.halves[0], options_, solver_);
    return average_by_counts(a, input.halves[0].primal_count, b, input.halves[1].primal_count);
  }

 private:
  VarianceWeightOptions options_;
  bool cross_ = true;
  SolverOptions solver_;
};

}  // namespace

std::unique_ptr<Reconstruction> make_weighted() { return std::make_unique<Weighted>(); }

}  // namespace gradslc
