#pragma once
// The only list of lights that are no surfaces under test, and maps for them.

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "scene/lights/constant.h"
#include "scene/lights/directional.h"
#include "scene/lights/environment_map.h"
#include "scene/lights/point.h"
#include "scene/lights/spot.h"
#include "scene/lights/sun_sky_map.h"
#include "scene/loaders/transform.h"
#include "support/random.h"

namespace gradslc::test {

struct LightCase {
  std::string name;
  std::shared_ptr<const Light> light;
};

inline void PrintTo(const LightCase& c, std::ostream* stream) { *stream << c.name; }

inline RgbImage random_map(int width, int height, std::uint64_t seed) {
  TestRandom random(seed);
  RgbImage map({width, height});
  for (Rgb& texel : map) {
    const Vec2 rg = random.get2();
    texel = {rg.x, 0.5f * rg.y, 2 * random.get1()};
  }
  return map;
}

/// Black but for one bright texel.
inline RgbImage hot_map(int width, int height, Pixel hot) {
  RgbImage map({width, height});
  map[hot] = {1000, 900, 500};
  return map;
}

/// The lower rows are black, and so is the second quarter of the columns.
inline RgbImage partly_black_map(int width, int height) {
  RgbImage map = random_map(width, height, 5);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (2 * y >= height || 4 * x / width == 1) map(x, y) = Rgb();
  return map;
}

/// Turned about an oblique axis and, where wanted, mirrored.
inline Orientation oblique(bool mirrored = false) {
  const Transform turn = Transform::rotation(1, 2, -0.5, 130);
  Orientation orientation{turn.column(0), turn.column(1), turn.column(2)};
  if (mirrored) orientation.x = -orientation.x;
  return orientation;
}

/// Sky and a sun of 30 times its radius, small enough for tests of directions.
inline RgbImage small_sky(float sky_scale, float sun_scale) {
  const ClearSky sky{.sun = {0.9, -2.8}, .extend = true};
  RgbImage map = black_map(32);
  if (sky_scale > 0) add_sky(map, sky, sky_scale);
  if (sun_scale > 0) add_sun(map, sky, sun_scale, 30);
  return map;
}

inline std::vector<LightCase> environment_cases() {
  const auto map = [](RgbImage image, const Orientation& orientation = {}) {
    return std::make_shared<const EnvironmentMap>(std::move(image), orientation);
  };
  return {
      {"constant", std::make_shared<const ConstantLight>(Rgb(1, 2, 0.5f))},
      {"map", map(random_map(16, 8, 1))},
      {"map_of_odd_size", map(random_map(7, 5, 2))},
      {"map_turned", map(random_map(12, 6, 3), oblique())},
      {"map_mirrored", map(random_map(12, 6, 4), oblique(true))},
      {"map_partly_black", map(partly_black_map(16, 10), oblique())},
      {"map_with_a_hot_texel", map(hot_map(64, 32, {63, 9}), oblique())},
      {"map_with_a_hot_pole", map(hot_map(5, 3, {2, 0}))},
      {"map_of_one_texel", map(random_map(1, 1, 6))},
      {"map_of_one_column", map(random_map(1, 9, 7))},
      {"map_of_one_row", map(random_map(9, 1, 8))},
      {"sun", std::make_shared<const EnvironmentMap>(small_sky(0, 1), Orientation(), "sun")},
      {"sky", std::make_shared<const EnvironmentMap>(small_sky(1, 0), oblique(), "sky")},
      {"sunsky", std::make_shared<const EnvironmentMap>(small_sky(1, 1), Orientation(), "sunsky")},
  };
}

inline std::vector<LightCase> light_cases() {
  constexpr float degree = k_pi / 180;
  std::vector<LightCase> cases = environment_cases();
  const Vec3 oblique_axis = normalize({0.3f, -1, 0.2f});
  cases.push_back({"point", std::make_shared<const PointLight>(Point3{0.4f, 0.8f, -0.3f}, Rgb(3, 2, 1))});
  cases.push_back({"spot", std::make_shared<const SpotLight>(Point3{0, 0.9f, 0.1f}, oblique_axis, Rgb(3, 2, 1),
                                                             50 * degree, 20 * degree)});
  cases.push_back({"spot_without_falloff", std::make_shared<const SpotLight>(Point3{0, 0.9f, 0.1f}, oblique_axis,
                                                                             Rgb(2), 35 * degree, 35 * degree)});
  cases.push_back({"spot_backwards",
                   std::make_shared<const SpotLight>(Point3{0, 0.4f, 0}, oblique_axis, Rgb(2), 170 * degree, 0.0f)});
  cases.push_back({"directional", std::make_shared<const DirectionalLight>(oblique_axis, Rgb(3, 2, 1))});
  return cases;
}

}  // namespace gradslc::test
