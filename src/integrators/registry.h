#pragma once

#include <memory>

#include "integrators/integrator.h"

namespace gradslc {

std::unique_ptr<Integrator> make_path_tracer();
std::unique_ptr<Integrator> make_vpl_sampler();
std::unique_ptr<Integrator> make_lightcuts();
std::unique_ptr<Integrator> make_stochastic_lightcuts();
std::unique_ptr<Integrator> make_gradient_stochastic_lightcuts();
std::unique_ptr<Integrator> make_gradient_path_tracer();

}  // namespace gradslc
