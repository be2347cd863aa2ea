#include "scene/inventory.h"

#include <algorithm>
#include <limits>
#include <set>

namespace gradslc {
namespace {

/// Every map once, however many materials refer to it.
std::set<const TextureMap*> texture_maps(const Scene& scene) {
  std::set<const TextureMap*> maps;
  for (const MaterialPtr& material : scene.materials())
    for (const Texture& texture : material->textures())
      if (texture.map()) maps.insert(texture.map().get());
  return maps;
}

bool has_delta_lobes(const Scene& scene) {
  const LobeSelection all_but_delta{true, true, std::numeric_limits<float>::min()};
  return std::any_of(scene.materials().begin(), scene.materials().end(),
                     [&](const MaterialPtr& material) { return material->has_other_lobes(all_but_delta); });
}

}  // namespace

SceneInventory take_inventory(const Scene& scene) {
  SceneInventory inventory;
  inventory.resolution = scene.camera().resolution();
  inventory.camera_position = scene.camera().position();
  inventory.meshes = scene.meshes().size();
  inventory.triangles = scene.triangle_count();
  inventory.bounds = scene.bounds();
  for (const MaterialName& name : scene.material_names()) ++inventory.materials[name.kind];
  for (const TextureMap* map : texture_maps(scene))
    ++inventory.textures, inventory.texture_bytes += map->memory_bytes();
  for (const TriangleMesh& mesh : scene.meshes())
    if (mesh.area_light >= 0) ++inventory.lights["area"];
  bool delta_lights = false;
  for (const LightPtr& light : scene.lights()) {
    ++inventory.lights[std::string(light->kind())];
    inventory.light_bytes += light->memory_bytes();
    delta_lights |= light->is_delta();
  }
  inventory.emissive_triangles = scene.emitters().triangle_count();
  inventory.emitted_power = scene.emitters().power();
  inventory.delta_light_on_delta_lobes = delta_lights && has_delta_lobes(scene);
  inventory.geometry_bytes = scene.memory_bytes();
  inventory.notes = scene.notes();
  return inventory;
}

}  // namespace gradslc
