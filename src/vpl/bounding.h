#pragma once

#include <algorithm>

#include "core/constants.h"
#include "core/vec.h"

namespace gradslc {

/// Bounded gathering (after Kollig and Keller 2004; DESIGN 4). The strength of a connection between the connectable
/// lobes of x and y is
///   K = (pi f_c(x)) (pi f_c(y)) |cos_x cos_y| / d^2     (1/length^2),
/// each f by its largest channel, cos_x with the shading and cos_y with the geometric normal. VPL connections count
/// with weight min(1, b/K), and the ray through f_c(x) brings the rest back with weight max(0, 1 - b/K). Both sides
/// call these functions; any b > 0 gives the same sum.
inline float connection_strength(float pi_f_x, float pi_f_y, float cos_x, float cos_y, float distance_squared) {
  return pi_f_x * pi_f_y * std::abs(cos_x * cos_y) / distance_squared;
}

/// min(1, b/K), K >= 0.
inline float bounded_weight(float strength, float bound) { return strength > bound ? bound / strength : 1; }

/// max(0, 1 - b/K), K >= 0.
inline float compensation_weight(float strength, float bound) { return strength > bound ? 1 - bound / strength : 0; }

/// Largest distance at which K can exceed b, for the factors of x and an upper bound of pi f_c(y).
inline float compensation_reach(float pi_f_x, float cos_x, float max_pi_f_y, float bound) {
  return std::sqrt(pi_f_x * std::abs(cos_x) * max_pi_f_y / bound);
}

}  // namespace gradslc
