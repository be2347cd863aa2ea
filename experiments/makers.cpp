#include "experiments/makers.h"

#include "scene/loaders/loader.h"
#include "scene/scene.h"

namespace gradslc {

Makers real_makers() {
  const auto load = [](const ScenePlan& plan) {
    LoadOptions options;
    options.width = plan.width;
    options.height = plan.height;
    return Scene(load_scene(plan.file.string(), options));
  };
  Makers makers;
  makers.integrator = [](const MethodPlan& method) { return make_integrator(method); };
  makers.reconstruction = [](const MethodPlan& method) { return make_reconstruction(method); };
  makers.scene = load;
  makers.clock = system_time;
  return makers;
}

}  // namespace gradslc
