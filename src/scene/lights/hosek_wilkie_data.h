#pragma once
// Coefficients of the sky model of Hosek and Wilkie 2012 for linear sRGB: see hosek_wilkie_data.cpp.

#include <array>

namespace gradslc {

/// Six control points of a quintic Bezier curve over the sun's elevation, each the nine parameters of the sky's shape.
using HosekWilkieShape = std::array<std::array<double, 9>, 6>;
/// The same for the level of radiance.
using HosekWilkieLevel = std::array<double, 6>;

/// By channel (red, green, blue), ground albedo (0, 1) and turbidity (1 to 10).
extern const HosekWilkieShape k_hosek_wilkie_shape[3][2][10];
extern const HosekWilkieLevel k_hosek_wilkie_level[3][2][10];

}  // namespace gradslc
