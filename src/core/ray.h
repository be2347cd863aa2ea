#pragma once

#include "core/constants.h"
#include "core/vec.h"

namespace gradslc {

/// A ray or segment: hits count for distances in (0, max_distance), in units of `direction` (unit length for rays).
struct Ray {
  Point3 origin;
  Vec3 direction;
  float max_distance = k_infinity;

  Point3 at(float t) const { return origin + t * direction; }
};

}  // namespace gradslc
