#pragma once

#include <cstddef>
#include <memory>

#include "reconstruction/reconstruction.h"

namespace gradslc {

/// The input without values of primal, dx and dy that no other sample confirms: those by which the halves differ more
/// than `threshold` times the mean difference over 16 x 16 pixels, of which the largest tenth is left out of the mean,
/// or over one of the neighbouring squares. Of the two the larger one (by its absolutely largest channel) is removed:
/// it becomes the other half's, with count 0 and unknown variance. True edges are in both halves and so stay. Biased:
/// what is rare and bright is lost.
struct CleanedInput {
  ReconstructionInput input;
  std::size_t removed = 0;  ///< values
};
CleanedInput without_outliers(const ReconstructionInput& input, double threshold);

/// The reconstruction with the option to remove outliers from its input.
std::unique_ptr<Reconstruction> with_outlier_option(std::unique_ptr<Reconstruction> reconstruction);

}  // namespace gradslc
