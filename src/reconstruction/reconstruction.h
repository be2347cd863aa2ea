#pragma once

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

struct ReconstructionInput {
  ReconstructionBuffers halves[2];  ///< independent of each other
  /// Both halves together, weighted by counts.
  ReconstructionBuffers combined;
};

struct ReconstructionStatistics {
  int iterations = 0;
  double relative_residual = 0;  ///< largest of the channels, of the true residual b - A x
  bool converged = true;
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
  /// NaN or infinite primal or gradient values are an Error.
  virtual ReconstructionResult reconstruct(const ReconstructionInput& input) const = 0;
};

struct ReconstructionEntry {
  const char* name;
  const char* meaning;
  std::unique_ptr<Reconstruction> (*make)();
  bool needs_gradients;
};
/// The only list of reconstructions: none, l2, weighted.
std::span<const ReconstructionEntry> reconstruction_registry();

}  // namespace gradslc
