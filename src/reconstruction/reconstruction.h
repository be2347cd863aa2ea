#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/parameters.h"

namespace gradslc {

/// Estimates of an image and of its differences, from one half of the passes.
/// dx has the image's size; its last column and dy's last row are not used.
struct ReconstructionBuffers {
  RgbImage primal, dx, dy;
  Image<float> primal_count, dx_count, dy_count;       ///< samples; 0: no estimate there
  RgbImage primal_variance, dx_variance, dy_variance;  ///< of the means; infinite where unknown
};

/// What the pixels show, as far as it has little noise: guides of filters (DESIGN 7). 0 where no surface is seen.
struct FeatureBuffers {
  RgbImage albedo, normal;                    ///< normals are means of unit vectors, and so may be shorter
  Image<float> depth;                         ///< distance to the camera
  RgbImage albedo_variance, normal_variance;  ///< of the means
  Image<float> depth_variance;
};

struct ReconstructionInput {
  ReconstructionBuffers halves[2];  ///< independent of each other
  /// Both halves together, weighted by counts.
  ReconstructionBuffers combined;
  FeatureBuffers features;  ///< empty images where they were not recorded
};

struct ReconstructionStatistics {
  int iterations = 0;
  double relative_residual = 0;  ///< largest of the channels, of the true residual b - A x
  bool converged = true;
  std::size_t outliers = 0;  ///< values of primal and gradients that were left out
};

struct ReconstructionResult {
  RgbImage image;
  ReconstructionStatistics statistics;
};

/// Turns estimates of an image and its gradients into one image. Knows nothing of scenes. Deterministic.
class Reconstruction {
 public:
  virtual ~Reconstruction() = default;
  virtual void describe(ParameterVisitor& visitor) = 0;
  /// Whether it works with features: the film must then record them.
  virtual bool needs_features() const { return false; }
  /// NaN or infinite primal or gradient values are an Error.
  virtual ReconstructionResult reconstruct(const ReconstructionInput& input) const = 0;
};

struct ReconstructionEntry {
  const char* name;
  const char* meaning;
  std::unique_ptr<Reconstruction> (*make)();
  bool needs_gradients;
};
/// The only list of reconstructions.
std::span<const ReconstructionEntry> reconstruction_registry();

}  // namespace gradslc
