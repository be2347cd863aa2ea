#pragma once

#include <algorithm>
#include <cmath>

namespace gradslc {

/// Linear RGB with the primaries of sRGB: radiance, reflectance or throughput.
struct Rgb {
  float r = 0, g = 0, b = 0;
  constexpr Rgb() = default;
  constexpr explicit Rgb(float grey) : r(grey), g(grey), b(grey) {}
  constexpr Rgb(float red, float green, float blue) : r(red), g(green), b(blue) {}
  constexpr float operator[](int channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
  constexpr Rgb& operator+=(Rgb o) { return *this = {r + o.r, g + o.g, b + o.b}; }
  constexpr Rgb& operator*=(Rgb o) { return *this = {r * o.r, g * o.g, b * o.b}; }
  constexpr Rgb& operator*=(float s) { return *this = {r * s, g * s, b * s}; }
  bool operator==(const Rgb&) const = default;
};
constexpr Rgb operator+(Rgb a, Rgb b) { return a += b; }
constexpr Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Rgb operator*(Rgb a, Rgb b) { return a *= b; }
constexpr Rgb operator*(Rgb a, float s) { return a *= s; }
constexpr Rgb operator*(float s, Rgb a) { return a *= s; }
constexpr Rgb operator/(Rgb a, float s) { return {a.r / s, a.g / s, a.b / s}; }

constexpr bool is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }
constexpr float max_channel(Rgb a) { return std::max(a.r, std::max(a.g, a.b)); }
inline bool is_finite(Rgb a) { return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b); }

/// Relative luminance Y of linear sRGB (ITU-R BT.709).
constexpr float luminance(Rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

/// Linear value of an sRGB-encoded one in [0,1] (IEC 61966-2-1).
inline float srgb_to_linear(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }
/// sRGB encoding of a linear value, clamped to [0,1].
inline float linear_to_srgb(float v) {
  v = std::clamp(v, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

}  // namespace gradslc
