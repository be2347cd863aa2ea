#pragma once

#include "reconstruction/reconstruction.h"

namespace gradslc {

/// Error (input), naming the pixel, where a primal or gradient value is NaN or infinite, a count negative or not
/// finite, or a variance negative or NaN; and where the images' sizes differ or the image has no pixels. dx's last
/// column and dy's last row are not looked at.
void check_primal(const ReconstructionBuffers& buffers);
void check_primal_and_gradients(const ReconstructionBuffers& buffers);
/// Features of all pixels are there and finite.
void check_features(const FeatureBuffers& features, Resolution resolution);
/// Both halves, which must be of one size.
void check_halves(const ReconstructionInput& input);

}  // namespace gradslc
