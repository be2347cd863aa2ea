#pragma once

#include <filesystem>
#include <string>

#include "materials/texels.h"

namespace gradslc {

/// Reads an image file, whose content tells its format:
///   PNG   all kinds, as 8 or 16 bits; palettes are expanded; colour profiles and gamma chunks are left out
///   JPEG  baseline and progressive, grey or colour
///   TGA   grey, colour (16, 24 or 32 bits) or colour-mapped, with or without run lengths
///   BMP   1, 4 or 8 bits with a palette, 24 or 32 bits without alpha, not compressed
///   HDR   Radiance RGBE, as floats; EXPOSURE and COLORCORR are left out
///   EXR   R, G and B, or Y, as floats (see core/exr.h)
/// Error (input) where the file cannot be read, is of another kind, damaged or truncated, or larger than 65536 pixels
/// in width or height, or holds floats that are not finite. What is allocated is bounded by the file's size.
Texels read_image(const std::filesystem::path& file);
/// The same for a file's content; `file` is its name in messages.
Texels decode_image(const std::string& bytes, const std::filesystem::path& file);

}  // namespace gradslc
