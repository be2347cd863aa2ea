#include "reconstruction/methods.h"

namespace gradslc {
namespace {

constexpr ReconstructionEntry k_reconstructions[] = {
    {"none", "the primal image as it is", make_none, false},
    {"l2", "screened Poisson, weights from counts: unbiased", make_l2, true},
    {"weighted", "screened Poisson, weights from inverse variances", make_weighted, true},
    {"feature", "weighted, then regression on features and the other half of the passes", make_feature, true},
    {"denoise", "the same regression, or a bilateral filter, without gradients: a control", make_denoise, false},
};

}  // namespace

std::span<const ReconstructionEntry> reconstruction_registry() { return k_reconstructions; }

}  // namespace gradslc
