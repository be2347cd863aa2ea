#include "reconstruction/methods.h"

namespace gradslc {
namespace {

constexpr ReconstructionEntry k_reconstructions[] = {
    {"none", "the primal image as it is", make_none, false},
    {"l2", "screened Poisson, weights from counts: unbiased", make_l2, true},
    {"weighted", "screened Poisson, weights from inverse variances", make_weighted, true},
};

}  // namespace

std::span<const ReconstructionEntry> reconstruction_registry() { return k_reconstructions; }

}  // namespace gradslc
