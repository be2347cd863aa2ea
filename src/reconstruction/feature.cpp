#include <array>
#include <utility>

#include "reconstruction/blend.h"
#include "reconstruction/buffers.h"
#include "reconstruction/local_regression.h"
#include "reconstruction/methods.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// Gradients, then features (DESIGN 7): each half of the passes is reconstructed as by `weighted`, with the variances
/// of all passes, then smoothed by regression on features and the other half. Both are biased slightly. Variances of
/// all passes know of an outlier in either half, and depend only half as much on the values that they weigh as a half's
/// own.
class Feature final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.integer("radius", regression_.radius, {1, 32}, "pixels", "of the window of (2 radius + 1)^2 pixels");
    visitor.real("range", regression_.range, {0.1, 1000}, "",
                 "how many of their variances apart the other half's pixels may be, squared, to be alike");
    visitor.boolean("judged", judged_,
                    "go only as far from the solution towards its regression as the other half's, which has no bias, "
                    "confirms: not worse than `weighted` in the long run");
    visitor.boolean(
        "keep_mean", keep_mean_,
        "only gradients of the regression, and the primal's mean: a little more error, no shift of the mean");
    visitor.real("relative_residual", solver_.relative_residual, {1e-10, 0.1}, "",
                 "residual of the linear systems, relative to their right-hand sides, at which their solver stops");
  }
  bool needs_features() const override { return true; }

  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    check_halves(input);
    check_features(input.features, input.combined.primal.resolution());
    const auto solved = [&](int half, const ReconstructionBuffers& variances) {
      return solve_weighted(input.halves[half], variances, weights_, solver_);
    };
    ReconstructionResult halves[2] = {solved(0, input.combined), solved(1, input.combined)};
    std::array<RgbImage, 2> filtered = cross_filter(halves[0].image, halves[1].image, input.features, regression_);
    for (int h = 0; h < 2; ++h) {
      if (judged_) {
        const ReconstructionResult judge = solved(1 - h, input.halves[h]);
        filtered[h] = blend(halves[h].image, filtered[h], judge.image, k_judged_radius);
      }
      halves[h].image = std::move(filtered[h]);
    }
    const ReconstructionResult both =
        average_by_counts(halves[0], input.halves[0].primal_count, halves[1], input.halves[1].primal_count);
    return keep_mean_ ? with_mean_of_primal(both, input.combined) : both;
  }

 private:
  static constexpr int k_judged_radius = 7;

  /// The sum over the image is the primal's where all pixels have as many samples.
  ReconstructionResult with_mean_of_primal(const ReconstructionResult& filtered,
                                           const ReconstructionBuffers& buffers) const {
    const Resolution resolution = filtered.image.resolution();
    RgbImage dx(resolution), dy(resolution);
    for (int y = 0; y < resolution.height; ++y)
      for (int x = 0; x < resolution.width; ++x) {
        if (x + 1 < resolution.width) dx(x, y) = filtered.image(x + 1, y) - filtered.image(x, y);
        if (y + 1 < resolution.height) dy(x, y) = filtered.image(x, y + 1) - filtered.image(x, y);
      }
    PoissonWeights weights = count_weights(buffers, k_default_alpha);
    weights.dx = weights.dy = Image<float>(resolution, 1);
    ReconstructionResult result = solve({buffers.primal, dx, dy, weights}, solver_);
    result.statistics.iterations += filtered.statistics.iterations;
    result.statistics.converged &= filtered.statistics.converged;
    return result;
  }

  VarianceWeightOptions weights_;
  RegressionOptions regression_;
  bool judged_ = true, keep_mean_ = false;
  SolverOptions solver_{.relative_residual = 1e-3};  // noise is larger
};

}  // namespace

std::unique_ptr<Reconstruction> make_feature() { return std::make_unique<Feature>(); }

}  // namespace gradslc
