#include "integrators/registry.h"

namespace gradslc {
namespace {

constexpr IntegratorEntry k_integrators[] = {
    {"spt", "simple path tracing: next-event estimation and multiple importance sampling", make_path_tracer},
    {"vpl", "all virtual point lights, or a uniform or power-proportional sample of them", make_vpl_sampler},
    {"lightcuts", "lightcuts over virtual point lights: deterministic cuts by error bounds (biased)", make_lightcuts},
    {"slc", "stochastic lightcuts over virtual point lights", make_stochastic_lightcuts},
    {"gradslc", "stochastic lightcuts with gradients", make_gradient_stochastic_lightcuts},
    {"gpt", "gradient-domain path tracing (Kettunen et al. 2015)", make_gradient_path_tracer},
};

}  // namespace

std::span<const IntegratorEntry> integrator_registry() { return k_integrators; }

}  // namespace gradslc
