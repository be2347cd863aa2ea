#include "scene/summary.h"

namespace gradslc {

SceneSummary summarise(const Scene& scene) {
  SceneSummary summary;
  summary.triangles = scene.triangle_count();
  summary.meshes = scene.meshes().size();
  for (const MaterialName& name : scene.material_names()) ++summary.materials[name.kind];
  summary.emitters = scene.emitters().triangle_count();
  summary.emitter_power = scene.emitters().power();
  summary.bounds = scene.bounds();
  summary.memory_bytes = scene.memory_bytes();
  summary.resolution = scene.camera().resolution();
  summary.notes = scene.notes();
  return summary;
}

}  // namespace gradslc
