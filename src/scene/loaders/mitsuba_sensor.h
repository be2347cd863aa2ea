#pragma once

#include "scene/camera.h"
#include "scene/loaders/loader.h"
#include "scene/loaders/mitsuba_document.h"

namespace gradslc {

constexpr int k_max_film_size = 65536;  ///< pixels, for width and height

/// The camera of a <sensor type="perspective"> or "thinlens" with its film. The image is the film's crop window alone;
/// the field of view is that of the whole film, as in Mitsuba. The options' width and height are the whole film's, and
/// the crop window keeps its place on it, its edges rounded to pixels.
/// Throws Error (input) for other sensors and for transforms that scale axes differently.
PerspectiveCamera read_sensor(MitsubaDocument& document, const XmlElement& sensor, const LoadOptions& options);

}  // namespace gradslc
