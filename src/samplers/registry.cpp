#include "samplers/sampler.h"

namespace gradslc {
namespace {

constexpr SamplerEntry k_samplers[] = {
    {"independent", SamplerKind::independent, "independent random numbers"},
    {"sobol", SamplerKind::sobol, "Owen-scrambled Sobol points, padded in pairs (Burley 2020)"},
};

}  // namespace

std::span<const SamplerEntry> sampler_registry() { return k_samplers; }

}  // namespace gradslc
