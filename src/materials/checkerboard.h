#pragma once

#include <memory>

#include "materials/texture.h"
#include "materials/uv_transform.h"

namespace gradslc {

/// Squares of edge 0.5, two by two in each unit square: `first` where both coordinates are in the lower or both in the
/// upper half, `second` elsewhere. The colours see the surface's own uv. gradient() leaves the steps out.
std::shared_ptr<const TextureMap> make_checkerboard(Texture first, Texture second, const UvTransform& to_uv);

}  // namespace gradslc
