#pragma once

#include <cstdint>

#include "core/vec.h"

namespace gradslc {

/// A unit vector in 32 bits: octahedral map, 16 bits an axis (Cigolle et al. 2014). Error below 6e-5 rad.
class OctahedralNormal {
 public:
  OctahedralNormal() = default;
  explicit OctahedralNormal(Vec3 v) {
    const float norm = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    float x = v.x / norm, y = v.y / norm;
    if (v.z < 0) {
      const float folded_x = (1 - std::abs(y)) * std::copysign(1.0f, x);
      y = (1 - std::abs(x)) * std::copysign(1.0f, y);
      x = folded_x;
    }
    x_ = encode(x), y_ = encode(y);
  }

  Vec3 decode() const {
    float x = static_cast<float>(x_) / 32767, y = static_cast<float>(y_) / 32767;
    const float z = 1 - std::abs(x) - std::abs(y);
    const float fold = std::max(-z, 0.0f);
    x -= std::copysign(fold, x), y -= std::copysign(fold, y);
    return normalize(Vec3{x, y, z});
  }
  /// As stored: coordinate 0 or 1 of the map, times 32767.
  std::int16_t stored(int axis) const { return axis == 0 ? x_ : y_; }
  bool operator==(const OctahedralNormal&) const = default;

 private:
  static std::int16_t encode(float value) { return static_cast<std::int16_t>(std::lround(value * 32767)); }
  std::int16_t x_ = 0, y_ = 0;
};

}  // namespace gradslc
