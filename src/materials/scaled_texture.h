#pragma once

#include "materials/texture.h"

namespace gradslc {

/// A texture times a factor per channel. Its gradient is exact where the texture or the factor is grey:
/// elsewhere the factor's luminance stands for the factor.
Texture scale_texture(const Texture& texture, Rgb factor);

}  // namespace gradslc
