#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/bounds.h"
#include "core/image.h"
#include "core/rgb.h"
#include "scene/scene.h"

namespace gradslc {

/// What `gradslc info` tells of a scene.
struct SceneInventory {
  Resolution resolution;
  Point3 camera_position;
  std::size_t meshes = 0, triangles = 0;  ///< triangles with area
  Bounds3 bounds;
  std::map<std::string, int> materials;  ///< by plug-ins ("twosided diffuse"), how many the shapes use
  std::size_t textures = 0;              ///< maps, each once
  std::map<std::string, int> lights;     ///< by plug-in; "area" counts shapes
  std::size_t emissive_triangles = 0;
  Rgb emitted_power;  ///< flux
  /// Light of delta emitters (point, spot, directional) that a delta lobe scatters first is outside of what any method
  /// estimates (DESIGN 2).
  bool delta_light_on_delta_lobes = false;
  std::size_t geometry_bytes = 0;  ///< meshes and acceleration structure
  std::size_t texture_bytes = 0;
  std::size_t light_bytes = 0;
  std::vector<std::string> notes;
};

SceneInventory take_inventory(const Scene& scene);

}  // namespace gradslc
