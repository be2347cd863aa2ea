#pragma once

#include "scene/camera.h"
#include "scene/loaders/loader.h"
#include "scene/loaders/mitsuba_document.h"

namespace gradslc {

constexpr int k_max_film_size = 65536;  ///< pixels, for width and height

/// The camera of a <sensor type="perspective"> with its film. Throws Error (input) for other sensors and for what
/// would change the image and is not supported (crop windows, principal point offsets).
PerspectiveCamera read_sensor(MitsubaDocument& document, const XmlElement& sensor, const LoadOptions& options);

}  // namespace gradslc
