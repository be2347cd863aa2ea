#pragma once

#include "integrators/path.h"

namespace gradslc {

/// A camera path up to its gather vertex x: it follows lobes that VPLs cannot represent (f_s) until it takes a
/// connectable one (DESIGN 4).
struct CameraPrefix {
  PartValues radiance;               ///< light met on the way: part `prefix`
  std::optional<PathVertex> gather;  ///< x; nullopt: the path ended before
  Rgb throughput;                    ///< up to x, over the probability of the lobes taken
};

/// `position` as PerspectiveCamera::generate_ray takes it. Random numbers are those of `context`.
CameraPrefix trace_camera_prefix(PathContext& context, Vec2 position);

}  // namespace gradslc
