#include <algorithm>
#include <cstddef>

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
      return solve_weighted(input.combined, input.combined);
    }
    check_halves(input);
    const ReconstructionResult a = solve_weighted(input.halves[0], input.halves[1]);
    const ReconstructionResult b = solve_weighted(input.halves[1], input.halves[0]);
    return average(a, input.halves[0].primal_count, b, input.halves[1].primal_count);
  }

 private:
  ReconstructionResult solve_weighted(const ReconstructionBuffers& buffers, const ReconstructionBuffers& source) const {
    const PoissonWeights weights = variance_weights(buffers, source, options_);
    return solve({buffers.primal, buffers.dx, buffers.dy, weights}, solver_);
  }

  /// By counts; the plain mean where neither half has samples.
  static ReconstructionResult average(const ReconstructionResult& a, const Image<float>& a_count,
                                      const ReconstructionResult& b, const Image<float>& b_count) {
    ReconstructionResult result{
        .image = RgbImage(a.image.resolution()),
        .statistics = {.iterations = a.statistics.iterations + b.statistics.iterations,
                       .relative_residual = std::max(a.statistics.relative_residual, b.statistics.relative_residual),
                       .converged = a.statistics.converged && b.statistics.converged}};
    for (std::size_t i = 0; i < result.image.size(); ++i) {
      const float count = a_count[i] + b_count[i];
      const float share = count > 0 ? a_count[i] / count : 0.5f;
      result.image[i] = b.image[i] + (a.image[i] - b.image[i]) * share;
    }
    return result;
  }

  VarianceWeightOptions options_;
  bool cross_ = true;
  SolverOptions solver_;
};

}  // namespace

std::unique_ptr<Reconstruction> make_weighted() { return std::make_unique<Weighted>(); }

}  // namespace gradslc
