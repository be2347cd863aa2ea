#pragma once

#include "core/rgb.h"
#include "core/vec.h"

namespace gradslc {

/// A reflectance or other colour over a surface's uv coordinates: linear RGB.
class Texture {
 public:
  Texture() = default;
  explicit Texture(Rgb constant) : constant_(constant) {}
  Rgb eval(Vec2 /*uv*/) const { return constant_; }
  /// Per channel, never below eval() anywhere.
  Rgb max_value() const { return constant_; }

 private:
  Rgb constant_;
};

}  // namespace gradslc
