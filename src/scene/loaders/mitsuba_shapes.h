#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scene/loaders/mitsuba_properties.h"
#include "scene/mesh.h"

namespace gradslc {

/// A shape whose properties have been read, and whose mesh is still to be made.
struct ShapePlan {
  /// The mesh in world space; name, material and light are left to the caller. Needs nothing of the document: may run
  /// on any thread.
  std::function<TriangleMesh()> make;
  std::uintmax_t bytes = 0;  ///< of the file to be read; 0: none
};

struct ShapeEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  ShapePlan (*plan)(MitsubaDocument& document, MitsubaProperties& properties);  ///< nullptr: made of other shapes
};
/// The only list of shape plug-ins.
std::span<const ShapeEntry> shape_registry();

constexpr const char* k_shape_group = "shapegroup";
constexpr const char* k_instance = "instance";

}  // namespace gradslc
