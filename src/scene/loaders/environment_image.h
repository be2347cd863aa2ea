#pragma once

#include <filesystem>

#include "core/image.h"

namespace gradslc {

/// Linear RGB of an EXR file, half or float. Error (input) where it cannot be read or has no channels R, G and B.
RgbImage read_environment_image(const std::filesystem::path& path);

}  // namespace gradslc
