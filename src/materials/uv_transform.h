#pragma once

#include "core/vec.h"

namespace gradslc {

/// An affine map from a surface's uv coordinates to a texture's.
struct UvTransform {
  Vec2 u_row{1, 0}, v_row{0, 1}, offset;  ///< u' = u_row . (u,v) + offset.x, v' alike

  constexpr Vec2 apply(Vec2 uv) const {
    return {u_row.x * uv.x + u_row.y * uv.y + offset.x, v_row.x * uv.x + v_row.y * uv.y + offset.y};
  }
  /// Derivatives by the surface's coordinates of what has these derivatives by the texture's.
  constexpr Vec2 chain(Vec2 derivatives) const {
    return {u_row.x * derivatives.x + v_row.x * derivatives.y, u_row.y * derivatives.x + v_row.y * derivatives.y};
  }
};

}  // namespace gradslc
