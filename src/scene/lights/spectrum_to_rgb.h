#pragma once

#include <array>

#include "core/rgb.h"

namespace gradslc {

/// Integral over wavelength of the CIE 1931 function y, nm.
constexpr double k_integral_of_y = 106.856980;

/// A spectrum at 380, 385 ... 750 nm.
constexpr std::size_t k_spectrum_samples = 75;
using VisibleSpectrum = std::array<double, k_spectrum_samples>;
constexpr double wavelength(std::size_t sample) { return 380.0 + 5.0 * static_cast<double>(sample); }

/// Linear sRGB by the CIE 1931 colour matching functions, scaled so that an equal-energy spectrum of value 1 has Y = 1.
/// What lies outside the gamut is clamped to 0.
Rgb spectrum_to_rgb(const VisibleSpectrum& spectrum);

}  // namespace gradslc
