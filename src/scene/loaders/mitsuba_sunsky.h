#pragma once

#include <vector>

#include "scene/emitters.h"
#include "scene/loaders/mitsuba_properties.h"

namespace gradslc {

/// Mitsuba 0.6's `sun`, `sky` and `sunsky`: a baked latitude-longitude map, +y up; a directional light takes the place
/// of a sun without radius. Mitsuba 3's `sunsky`, +z up, becomes the same model (its own sun is another one).
std::vector<LightPtr> make_sun(MitsubaDocument& document, MitsubaProperties& properties);
std::vector<LightPtr> make_sky(MitsubaDocument& document, MitsubaProperties& properties);
std::vector<LightPtr> make_sunsky(MitsubaDocument& document, MitsubaProperties& properties);

}  // namespace gradslc
