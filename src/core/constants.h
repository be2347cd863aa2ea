#pragma once

#include <limits>
#include <numbers>

namespace gradslc {

constexpr float k_pi = std::numbers::pi_v<float>;
constexpr float k_inv_pi = std::numbers::inv_pi_v<float>;
constexpr float k_infinity = std::numeric_limits<float>::infinity();
/// Largest float below 1: random numbers lie in [0, k_one_minus_epsilon].
constexpr float k_one_minus_epsilon = 1 - std::numeric_limits<float>::epsilon() / 2;

}  // namespace gradslc
