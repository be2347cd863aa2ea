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
  return {make_integrator, make_reconstruction, load, system_time};
}

}  // namespace gradslc
