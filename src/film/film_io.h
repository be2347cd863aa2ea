#pragma once

#include <map>
#include <string>

#include "core/exr.h"
#include "film/film.h"

namespace gradslc {

/// What reconstructions and files need of a moment image.
struct MomentLayers {
  RgbImage mean;
  RgbImage variance;   ///< of the mean; infinite with fewer than two sets
  Image<float> count;  ///< samples
};
/// Both halves of an image together: means weighted by counts, variances from all sets.
MomentLayers moment_layers(const MomentImage& a, const MomentImage& b);
MomentLayers moment_layers(const MomentImage& image);

/// The features of a film's pixels, of both halves together.
struct FeatureLayers {
  RgbImage albedo, normal;
  Image<float> depth;
  RgbImage albedo_variance, normal_variance;  ///< of the means
  Image<float> depth_variance;
};
FeatureLayers feature_layers(const Film& film);

/// The layers of a run's EXR beside the default one, which is the caller's image:
/// `primal`, `variance` (of the primal), `invalid` (samples per pixel, over primal, dx and dy);
/// with gradients `dx`, `dy`, `dx_variance`, `dy_variance`;
/// per half h = a, b what is needed to reconstruct again: `primal_h`, `primal_variance_h`, `primal_count_h`, with
/// gradients the same for dx and dy; with parts `direct`, `vpl`, `compensation`, `specular`, `prefix`.
/// With features `albedo`, `normal`, `depth` and their `_variance`.
/// Counts, depth and `invalid` have one channel, and so have, with debug,
/// `debug_cut_size`, `debug_node_evaluations` and `debug_rays`, means over the pixel's samples;
/// `debug_contribution`, the luminance of the largest single contribution to any of them, `debug_contribution_part`,
/// its part as an index into k_part_names, and `debug_contribution_pass`; `debug_sample`, the luminance of the largest
/// sample, and `debug_sample_pass`. Part and pass are -1 where there is none.
std::map<std::string, ExrLayer> film_layers(const Film& film);

}  // namespace gradslc
