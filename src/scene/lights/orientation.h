#pragma once

#include "core/vec.h"

namespace gradslc {

/// A rotation, perhaps mirrored, from a light's own space to the world: the images of its axes, orthonormal.
struct Orientation {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 to_world(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace gradslc
