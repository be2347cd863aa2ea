#include "experiments/experiment.h"

#include "experiments/method_plan.h"

namespace gradslc {

Registries all_registries() { return {integrator_registry(), reconstruction_registry(), sampler_registry()}; }

std::unique_ptr<Integrator> make_integrator(const MethodPlan& method) {
  return make_integrator(method, all_registries());
}

std::unique_ptr<Reconstruction> make_reconstruction(const MethodPlan& method) {
  return make_reconstruction(method, all_registries());
}

}  // namespace gradslc
