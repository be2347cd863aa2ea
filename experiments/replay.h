#pragma once

#include <string>

#include "experiments/experiment.h"
#include "integrators/path_log.h"

namespace gradslc {

class Scene;

/// One sample of one pixel, again.
struct Replay {
  Pixel pixel;
  PathLog log;
  Rgb recorded;  ///< by the film of that pass; 0 where the sample was not finite
};

/// Renders the sample of `pixel` that `pass` of the method takes with these settings, and what else that needs. Parts
/// are told apart where `parts` asks for it, as in the image that is to be explained. Error where the pixel is outside
/// of the image.
Replay replay_sample(const Scene& scene, const MethodPlan& method, const RenderSettings& settings, Pixel pixel,
                     std::uint32_t pass, bool parts);

/// The sample's paths, connections and sums, to be read.
std::string to_text(const Replay& replay, const Scene& scene);

}  // namespace gradslc
