#pragma once

#include <filesystem>
#include <optional>

#include "core/exr.h"
#include "film/film.h"
#include "reconstruction/reconstruction.h"

namespace gradslc {

/// What a reconstruction works on: means, counts and variances of both halves and of both together. A set that is still
/// open counts as one closed here. dx and dy of a film without gradients have count 0 and unknown (infinite) variance.
ReconstructionInput reconstruction_input(const Film& film);

/// The same from the layers of a run's EXR (film_io.h), whose name `path` is for messages. Error (input) where one that
/// every run has is missing; gradients and features that were not recorded are as of a film without them.
ReconstructionInput reconstruction_input(const ExrImage& run, const std::filesystem::path& path);

/// A method's image: its primal where `reconstruction` is null.
struct FinalImage {
  RgbImage image;
  std::optional<ReconstructionStatistics> reconstruction;
};
FinalImage final_image(const Film& film, const Reconstruction* reconstruction);

}  // namespace gradslc
