#include "reconstruction/methods.h"
#include "reconstruction/outliers.h"

namespace gradslc {
namespace {

template <std::unique_ptr<Reconstruction> (*make)()>
std::unique_ptr<Reconstruction> with_options() {
  return with_outlier_option(make());
}

constexpr ReconstructionEntry k_reconstructions[] = {
    {"none", "the primal image as it is", with_options<make_none>, false},
    {"l2", "screened Poisson, weights from counts: unbiased", with_options<make_l2>, true},
    {"l1", "screened Poisson, absolute instead of squared deviations", with_options<make_l1>, true},
    {"weighted", "screened Poisson, weights from inverse variances", with_options<make_weighted>, true},
    {"feature", "weighted, then regression on features and the other half of the passes", with_options<make_feature>,
     true},
    {"denoise", "the same regression, or a bilateral filter, without gradients: a control", with_options<make_denoise>,
     false},
};

}  // namespace

std::span<const ReconstructionEntry> reconstruction_registry() { return k_reconstructions; }

}  // namespace gradslc
