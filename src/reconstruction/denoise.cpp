#include "reconstruction/buffers.h"
#include "reconstruction/local_regression.h"
#include "reconstruction/methods.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// The control that tells what filtering brings from what gradients bring: `feature`'s regression on the primal's
/// halves, or, simpler, a joint bilateral filter. Any method has what it needs. Biased.
class Denoise final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.choice("kind", kind_, {"regression", "bilateral"},
                   "a linear fit of features and the other half, as `feature` has it, or a weighted mean");
    visitor.integer("radius", options_.radius, {1, 32}, "pixels", "of the window of (2 radius + 1)^2 pixels");
    visitor.real("range", options_.range, {0.1, 1000}, "",
                 "how many of their variances apart the other half's pixels may be, squared, to be alike");
  }
  bool needs_features() const override { return true; }

  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    for (const ReconstructionBuffers& half : input.halves) check_primal(half);
    check_features(input.features, input.combined.primal.resolution());
    RegressionOptions options = options_;
    options.first_order = kind_ == Kind::regression;
    const ReconstructionBuffers &a = input.halves[0], &b = input.halves[1];
    const auto filtered = cross_filter(a.primal, b.primal, input.features, options);
    return average_by_counts({filtered[0], {}}, a.primal_count, {filtered[1], {}}, b.primal_count);
  }

 private:
  enum class Kind : std::uint8_t { regression, bilateral };
  Kind kind_ = Kind::regression;
  RegressionOptions options_;
};

}  // namespace

std::unique_ptr<Reconstruction> make_denoise() { return std::make_unique<Denoise>(); }

}  // namespace gradslc
