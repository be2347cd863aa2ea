#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "core/image.h"

namespace gradslc {

/// A named layer: three channels `name.R`, `name.G`, `name.B` of a file, or the one channel `name.Y`.
using ExrLayer = std::variant<RgbImage, Image<float>>;

/// What an EXR file holds for us. All images have the same resolution, the file's display window.
struct ExrImage {
  RgbImage image;  ///< the default layer, channels R, G and B, or Y for all three: what viewers show
  std::map<std::string, ExrLayer> layers;
  std::map<std::string, std::string> attributes;  ///< the header's string attributes
};

/// Writes one scanline part of 32-bit float channels with ZIP compression (lossless: NaN and infinities survive), all
/// or nothing. The same content gives the same bytes for any number of threads.
void write_exr(const std::filesystem::path& path, const ExrImage& content);

/// Reads the first part of a scanline or tiled file with half or float channels. The image is the display window:
/// pixels of it outside the data window are 0, data outside it are left out. Channels other than R, G, B, `layer.R`,
/// `layer.G`, `layer.B`, Y and `layer.Y` are left out. Error (input) where the file cannot be read, is damaged or
/// truncated, or has neither R, G and B nor Y.
ExrImage read_exr(const std::filesystem::path& path);
/// The same for a file's content; `path` is its name in messages.
ExrImage decode_exr(const std::string& bytes, const std::filesystem::path& path);

}  // namespace gradslc
