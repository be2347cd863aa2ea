#pragma once

#include <string>

#include "core/image.h"

namespace gradslc {

/// The image times `exposure`, encoded as sRGB, as the bytes of a PNG file.
std::string encode_png(const RgbImage& image, float exposure);

/// Exposure at which the pixel brighter than 95 % of them has 80 % of display white; 1 for a black image.
float display_exposure(const RgbImage& image);

/// Signed relative error of each pixel's luminance, (x - r) / (|r| + 0.1 mean(r)), as a display image: white 0, red +1
/// (too bright), blue -1 (too dark). The mean of `reference` must be positive.
RgbImage error_image(const RgbImage& image, const RgbImage& reference);

std::string base64(const std::string& bytes);

}  // namespace gradslc
