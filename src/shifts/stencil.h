#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"

namespace gradslc {

/// Which neighbours a base pixel shifts to.
enum class Stencil : std::uint8_t {
  forward,   ///< right and lower
  symmetric  ///< all four
};

inline constexpr Pixel k_stencil_offsets[] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// Offsets from the base, the base itself first, then right, lower, and for symmetric left and upper.
constexpr std::span<const Pixel> stencil_offsets(Stencil stencil) {
  return std::span(k_stencil_offsets).first(stencil == Stencil::forward ? 3 : 5);
}

/// Positions in stencil_offsets().
constexpr std::size_t k_base = 0, k_right = 1, k_lower = 2, k_left = 3, k_upper = 4;

}  // namespace gradslc
