#pragma once

#include <optional>

#include "film/film.h"
#include "reconstruction/reconstruction.h"

namespace gradslc {

/// What a reconstruction works on: means, counts and variances of both halves and of both together. A set that is still
/// open counts as one closed here. dx and dy of a film without gradients have count 0 and unknown (infinite) variance.
ReconstructionInput reconstruction_input(const Film& film);

/// A method's image: its primal where `reconstruction` is null.
struct FinalImage {
  RgbImage image;
  std::optional<ReconstructionStatistics> reconstruction;
};
FinalImage final_image(const Film& film, const Reconstruction* reconstruction);

}  // namespace gradslc
