#include "scene/lights/sun_sky_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "scene/lights/hosek_wilkie.h"

namespace gradslc {
namespace {

constexpr double k_half_pi = std::numbers::pi / 2;
constexpr std::size_t k_rows_per_chunk = 8;

double angle_between(double theta, double phi, const SunPosition& sun) {
  const double cosine = std::cos(theta) * std::cos(sun.zenith_angle) +
                        std::sin(theta) * std::sin(sun.zenith_angle) * std::cos(phi - sun.azimuth);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// 3 x^2 - 2 x^3 of x clamped to [0,1].
double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

Rgb sky_radiance(const HosekWilkieSky& model, const ClearSky& sky, double theta, double phi) {
  double shrunk = theta / sky.stretch;
  if (!(std::cos(shrunk) > 0)) {
    if (!sky.extend) return Rgb();
    constexpr double just_above = 1e-4;
    shrunk = k_half_pi - just_above;
  }
  const Rgb radiance = model.radiance(shrunk, angle_between(shrunk, phi, sky.sun));
  if (!sky.extend) return radiance;
  return static_cast<float>(smooth_step(2 - 2 * theta / std::numbers::pi)) * radiance;
}

/// Solid angle of a disk of that radius, over 2 pi: 1 - cos.
double cap(double radius) { return 2 * std::pow(std::sin(radius / 2), 2); }

/// Half the width in azimuth of a disk around a point at `centre` from the zenith, in the parallel at `theta`; radians
/// in [0, pi].
double half_width(double theta, double centre, double radius) {
  const double sines = std::sin(theta) * std::sin(centre);
  const double missing = std::cos(radius) - std::cos(theta) * std::cos(centre);
  if (std::abs(missing) >= sines) return missing < 0 ? std::numbers::pi : 0;
  return std::acos(missing / sines);
}

}  // namespace

RgbImage black_map(int width) { return RgbImage({width, width / 2}); }

void add_sky(RgbImage& map, const ClearSky& sky, float scale) {
  const HosekWilkieSky model(sky.turbidity, sky.albedo, k_half_pi - sky.sun.zenith_angle);
  parallel_for(static_cast<std::size_t>(map.height()), k_rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < map.width(); ++x)
        map(x, y) += scale * sky_radiance(model, sky, (y + 0.5) * std::numbers::pi / map.height(),
                                          (x + 0.5) * 2 * std::numbers::pi / map.width());
  });
}

void add_sun(RgbImage& map, const ClearSky& sky, float scale, double radius_scale) {
  constexpr int strips = 256;  // of a row, each with its exact width
  const double radius = k_sun_radius * radius_scale, centre = sky.sun.zenith_angle * sky.stretch;
  const double thinner = cap(k_sun_radius) / cap(radius);
  const Rgb radiance = static_cast<float>(scale * thinner) * sun_radiance(sky.sun.zenith_angle, sky.turbidity);
  const double column_width = 2 * std::numbers::pi / map.width(),
               strip_height = std::numbers::pi / map.height() / strips;
  std::vector<double> covered(static_cast<std::size_t>(map.width()));
  for (int y = 0; y < map.height(); ++y) {
    std::fill(covered.begin(), covered.end(), 0);
    for (int strip = 0; strip < strips; ++strip) {
      const double half = half_width((y * strips + strip + 0.5) * strip_height, centre, radius);
      if (half == 0) continue;
      const double first = (sky.sun.azimuth - half) / column_width, last = (sky.sun.azimuth + half) / column_width;
      const int begin = static_cast<int>(std::floor(first)), end = static_cast<int>(std::ceil(last));
      for (int column = begin; column < end; ++column) {
        const int wrapped = (column % map.width() + map.width()) % map.width();
        covered[static_cast<std::size_t>(wrapped)] +=
            (std::min<double>(last, column + 1) - std::max<double>(first, column)) / strips;
      }
    }
    for (int x = 0; x < map.width(); ++x)
      map(x, y) += static_cast<float>(covered[static_cast<std::size_t>(x)]) * radiance;
  }
}

Rgb sun_irradiance(const ClearSky& sky) {
  const double solid_angle = 2 * std::numbers::pi * cap(k_sun_radius);
  return static_cast<float>(solid_angle) * sun_radiance(sky.sun.zenith_angle, sky.turbidity);
}

Vec3 sun_direction(const ClearSky& sky) {
  const double theta = sky.sun.zenith_angle * sky.stretch;
  return {static_cast<float>(std::sin(theta) * std::sin(sky.sun.azimuth)), static_cast<float>(std::cos(theta)),
          static_cast<float>(-std::sin(theta) * std::cos(sky.sun.azimuth))};
}

}  // namespace gradslc
