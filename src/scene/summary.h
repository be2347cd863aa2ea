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
struct SceneSummary {
  std::size_t triangles = 0;  ///< with area
  std::size_t meshes = 0;
  std::map<std::string, int> materials;  ///< by plug-ins ("twosided diffuse"), how many the shapes use
  std::size_t emitters = 0;              ///< emissive triangles
  Rgb emitter_power;                     ///< flux
  Bounds3 bounds;
  std::size_t memory_bytes = 0;  ///< meshes and acceleration structure
  Resolution resolution;
  std::vector<std::string> notes;
};

SceneSummary summarise(const Scene& scene);

}  // namespace gradslc
