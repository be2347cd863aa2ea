#pragma once

#include <span>

#include "scene/emitters.h"
#include "scene/loaders/mitsuba_properties.h"

namespace gradslc {

struct LightEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  LightPtr (*make)(MitsubaDocument& document, MitsubaProperties& properties);
};
/// The only list of emitter plug-ins but for `area`, which belongs to a shape.
std::span<const LightEntry> light_registry();

}  // namespace gradslc
