#include "experiments/scene_check.h"

#include <set>

#include "scene/loaders/loader.h"
#include "scene/scene.h"

namespace gradslc {

void check_scenes(const Experiment& experiment, Problems& problems) {
  std::set<std::filesystem::path> checked;
  for (const ScenePlan& scene : experiment.scenes) {
    if (!checked.insert(scene.file).second) continue;
    try {
      Scene{load_scene(scene.file.string())};
    } catch (const Error& error) {
      if (error.kind() == Error::Kind::failure) throw;
      problems.add(error.where(), error.message());
    }
  }
}

}  // namespace gradslc
