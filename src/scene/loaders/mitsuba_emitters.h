#pragma once

#include <span>
#include <vector>

#include "scene/emitters.h"
#include "scene/lights/orientation.h"
#include "scene/loaders/mitsuba_properties.h"

namespace gradslc {

struct LightEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  /// One light, or more where a plug-in stands for several.
  std::vector<LightPtr> (*make)(MitsubaDocument& document, MitsubaProperties& properties);
};
/// The only list of emitter plug-ins but for `area`, which belongs to a shape.
std::span<const LightEntry> light_registry();

/// A colour whose channels are >= 0.
Rgb non_negative_colour(MitsubaProperties& properties, const char* name, Rgb default_value);
/// A number >= 0.
float non_negative_real(MitsubaProperties& properties, const char* name, float default_value);
/// The rotation of `to_world`, perhaps mirrored; an error where it shears or scales its axes differently.
Orientation read_orientation(MitsubaProperties& properties);
/// A unit vector of any given one but zero.
Vec3 unit_vector(MitsubaProperties& properties, const char* name, Vec3 default_value);

}  // namespace gradslc
