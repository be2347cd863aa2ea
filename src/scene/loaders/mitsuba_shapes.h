#pragma once

#include <span>

#include "scene/loaders/mitsuba_properties.h"
#include "scene/mesh.h"

namespace gradslc {

struct ShapeEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  /// The mesh in world space; name, material and light are left to the caller.
  TriangleMesh (*make)(MitsubaDocument& document, MitsubaProperties& properties);
};
/// The only list of shape plug-ins.
std::span<const ShapeEntry> shape_registry();

}  // namespace gradslc
