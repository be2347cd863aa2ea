#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "scene/lights/environment_map.h"
#include "scene/lights/hosek_wilkie.h"
#include "scene/lights/spectrum_to_rgb.h"
#include "scene/lights/sun_sky_map.h"
#include "scene/loaders/images.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

SunPosition position_of(Vec3 direction) {
  return {std::acos(direction.y / static_cast<double>(length(direction))), std::atan2(direction.x, -direction.z)};
}

double angle(Vec3 a, Vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// Mean direction of the light, weighted by power.
Vec3 mean_direction(const RgbImage& map) {
  double sum[3] = {0, 0, 0};
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const double theta = (y + 0.5) * std::numbers::pi / map.height();
      const double phi = 2 * std::numbers::pi * (x + 0.5) / map.width();
      const double weight = luminance(map(x, y)) * std::sin(theta);
      sum[0] += weight * std::sin(theta) * std::sin(phi);
      sum[1] += weight * std::cos(theta);
      sum[2] -= weight * std::sin(theta) * std::cos(phi);
    }
  return normalize({static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
}

/// The other renderer computes 1 - cos of the sun's radius in single precision, which makes its sun weaker.
double single_precision_loss() {
  const auto radius = static_cast<float>(k_sun_radius);
  return (1 - std::cos(radius)) / (1 - std::cos(k_sun_radius));
}

/// A map that the other renderer made, from the folder of references; nothing where that is missing.
RgbImage reference_map(const char* name) {
  const std::filesystem::path path = std::filesystem::path(GRADSLC_SHARED_DIR) / "references" / name;
  return std::filesystem::exists(path) ? linear_rgb(read_image(path)) : RgbImage();
}

const EnvironmentMap& only_map(const SceneDescription& scene) {
  EXPECT_EQ(scene.lights.size(), 1u);
  return dynamic_cast<const EnvironmentMap&>(*scene.lights.at(0));
}

SceneDescription legacy_scene(const std::string& emitter) {
  return load_scene_text("<scene version=\"0.5.0\">" + emitter +
                             "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor></scene>",
                         "test.xml");
}

TEST(SunSky, IsTheMapThatMitsubaMakesForTheHouse) {
  const RgbImage theirs = reference_map("house-environment.exr");
  if (theirs.empty()) GTEST_SKIP() << "references/house-environment.exr is not in the shared folder";
  const SceneDescription scene = legacy_scene(R"(<emitter type="sunsky"><float name="turbidity" value="3"/>
      <vector name="sunDirection" x="-0.445695" y="0.655031" z="-0.610156"/><float name="skyScale" value="6"/>
      <float name="sunScale" value="5"/><float name="sunRadiusScale" value="37.9165"/></emitter>)");
  const RgbImage& ours = only_map(scene).map();
  ASSERT_EQ(ours.resolution(), theirs.resolution());
  const Vec3 sun{-0.445695f, 0.655031f, -0.610156f};
  const double rim = 37.9165 * k_sun_radius;
  double disk_ours = 0, disk_theirs = 0;
  int sky_texels = 0;
  for (int y = 0; y < ours.height(); ++y)
    for (int x = 0; x < ours.width(); ++x) {
      const double theta = (y + 0.5) * std::numbers::pi / 256, phi = (x + 0.5) * std::numbers::pi / 256;
      const Vec3 direction{static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta)),
                           static_cast<float>(-std::sin(theta) * std::cos(phi))};
      const double from_sun = angle(direction, sun);
      if (std::abs(from_sun - rim) < 1.5 * k_degree) continue;  // their rim is jagged
      if (from_sun < rim) {
        disk_ours += luminance(ours(x, y)), disk_theirs += luminance(theirs(x, y));
        continue;
      }
      ++sky_texels;
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(ours(x, y)[channel], theirs(x, y)[channel], 1e-4f * theirs(x, y)[channel]) << x << ", " << y;
    }
  EXPECT_GT(sky_texels, 120'000);
  EXPECT_NEAR(disk_theirs / disk_ours, single_precision_loss(), 1e-3);
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(only_map(scene).integral()[channel] / EnvironmentMap(theirs, {}).integral()[channel], 1, 2e-3);
}

TEST(Sun, IsTheMapThatMitsubaMakesForTheLamp) {
  const RgbImage theirs = reference_map("lamp-environment.exr");
  if (theirs.empty()) GTEST_SKIP() << "references/lamp-environment.exr is not in the shared folder";
  const SceneDescription scene = legacy_scene(R"(<emitter type="sun">
      <vector name="sunDirection" x="0" y="0.804621" z="-0.593788"/><float name="scale" value="1"/>
      <float name="sunRadiusScale" value="18.8131"/></emitter>)");
  const EnvironmentMap &ours = only_map(scene), reference(theirs, {});
  EXPECT_EQ(ours.kind(), "sun");
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(reference.integral()[channel] / ours.integral()[channel], single_precision_loss(), 5e-4);
  EXPECT_LT(angle(mean_direction(ours.map()), mean_direction(theirs)), 0.01 * k_degree);
  EXPECT_LT(angle(mean_direction(ours.map()), {0, 0.804621f, -0.593788f}), 0.03 * k_degree);
}

// Also across the map's seam, near the zenith, and where the disk is smaller than a texel.
TEST(Sun, HasItsIrradianceWhateverItsRadius) {
  for (const SunPosition sun : {SunPosition{0.7, 1.2}, {1.2, 3.1415}, {0.9, 0.001}, {0.05, -2}, {1.4, 6}})
    for (const double radius_scale : {1.0, 5.0, 40.0}) {
      const ClearSky sky{.sun = sun};
      RgbImage map = black_map(1024);
      add_sun(map, sky, 2, radius_scale);
      const Vec3 direction = mean_direction(map);
      const EnvironmentMap light(std::move(map), {});
      // At the smallest sizes only few texels are lit, and cut obliquely by their parallels.
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(light.integral()[channel] / (2 * sun_irradiance(sky)[channel]), 1, 5e-3)
            << sun.zenith_angle << " " << radius_scale;
      EXPECT_LT(angle(direction, sun_direction(sky)), 0.1 * k_degree) << sun.zenith_angle << " " << radius_scale;
    }
}

TEST(Sun, IsRedderAndDimmerNearTheHorizon) {
  Rgb above = sun_radiance(0, 3);
  for (const double zenith : {0.5, 1.0, 1.3, 1.5, 1.57}) {
    const Rgb now = sun_radiance(zenith, 3);
    EXPECT_LT(luminance(now), luminance(above));
    EXPECT_LT(now.b / now.r, above.b / above.r);
    above = now;
  }
  EXPECT_LT(luminance(sun_radiance(1, 8)), luminance(sun_radiance(1, 2)));
}

// Illuminant E in linear sRGB: the sums of the rows of the matrix from XYZ.
TEST(SpectrumToRgb, OfEqualEnergyHasLuminanceOne) {
  VisibleSpectrum flat;
  flat.fill(1);
  const Rgb rgb = spectrum_to_rgb(flat);
  EXPECT_NEAR(rgb.r, 1.2048, 2e-3);
  EXPECT_NEAR(rgb.g, 0.9483, 2e-3);
  EXPECT_NEAR(rgb.b, 0.9089, 2e-3);
  EXPECT_NEAR(luminance(rgb), 1, 1e-3);
}

/// Of the cosine-weighted sky over the upper hemisphere, by a grid.
Rgb horizontal_irradiance(const HosekWilkieSky& model, double sun_zenith) {
  constexpr int rows = 24, columns = 24;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double sine = std::sqrt((i + 0.5) / rows), theta = std::asin(sine);
      const double phi = std::numbers::pi * (j + 0.5) / columns;
      const double gamma =
          std::acos(std::cos(theta) * std::cos(sun_zenith) + sine * std::sin(sun_zenith) * std::cos(phi));
      const Rgb radiance = model.radiance(theta, gamma);
      for (int c = 0; c < 3; ++c) sum[c] += radiance[c] * std::numbers::pi / (rows * columns);
    }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

// The fits were made apart for every turbidity, albedo and channel, and yet the sky changes smoothly: a grossly
// mistyped coefficient would show. At these elevations the six control points have their largest weights.
TEST(HosekWilkie, GoesSmoothlyFromTurbidityToTurbidity) {
  struct Case {
    double elevation, tolerance;  // degrees; of a logarithm, less than twice what the true coefficients show
  };
  for (const auto& [elevation, tolerance] :
       {Case{0, 0.04}, {0.72, 0.03}, {5.76, 0.06}, {19.44, 0.08}, {46.08, 0.08}, {90, 0.13}})
    for (const float albedo : {0.0f, 1.0f}) {
      std::vector<Rgb> irradiance;
      for (int turbidity = 1; turbidity <= 10; ++turbidity)
        irradiance.push_back(horizontal_irradiance(HosekWilkieSky(turbidity, Rgb(albedo), elevation * k_degree),
                                                   (90 - elevation) * k_degree));
      for (std::size_t i = 1; i + 1 < irradiance.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const double neighbours = (std::log(irradiance[i - 1][c]) + std::log(irradiance[i + 1][c])) / 2;
          EXPECT_NEAR(std::log(irradiance[i][c]), neighbours, tolerance)
              << "turbidity " << i + 1 << ", albedo " << albedo << ", elevation " << elevation << ", channel " << c;
        }
    }
}

TEST(HosekWilkie, IsLinearInAlbedoAndTurbidityBetweenTheFits) {
  const auto at = [](double turbidity, float albedo) {
    return HosekWilkieSky(turbidity, Rgb(albedo), 0.6).radiance(0.9, 0.4).g;
  };
  EXPECT_GT(at(3, 1), at(3, 0));
  EXPECT_NEAR(at(10, 0.3f), at(9.9999, 0.3f), 1e-3f * at(10, 0.3f));
  EXPECT_NEAR(at(4, 0.3f), at(3.9999, 0.3f), 1e-3f * at(4, 0.3f));
  EXPECT_NEAR(at(4, 0.3f), at(4.0001, 0.3f), 1e-3f * at(4, 0.3f));
}

TEST(Sky, EndsAtTheHorizonUnlessItIsStretchedOrExtended) {
  const auto texel = [](const ClearSky& sky, int row) {
    RgbImage map = black_map(64);
    add_sky(map, sky, 1);
    return map(5, row);
  };
  const ClearSky plain{.sun = {0.5, 1}};
  ClearSky stretched = plain, extended = plain;
  stretched.stretch = 2;
  extended.extend = true;
  EXPECT_FALSE(is_black(texel(plain, 15)));
  EXPECT_TRUE(is_black(texel(plain, 16)));
  EXPECT_FALSE(is_black(texel(stretched, 31)));
  EXPECT_EQ(texel(extended, 3), texel(plain, 3));
  EXPECT_GT(luminance(texel(extended, 18)), luminance(texel(extended, 28)));
  EXPECT_FALSE(is_black(texel(extended, 28)));
}

TEST(Sky, HasTheSameBitsForAnyNumberOfThreads) {
  const auto bake = [](int threads) {
    set_thread_count(threads);
    RgbImage map = black_map(64);
    add_sky(map, {.sun = {0.5, 1}}, 1);
    const EnvironmentMap light(map, {});
    set_thread_count(0);
    return std::pair(std::move(map), light.integral());
  };
  EXPECT_EQ(bake(1), bake(3));
}

// Solstices and equinox of 2010 (June 21, 11:28, December 21, 23:38, March 20, 17:32 UT); the equation of time is
// -1.7, +1.9 and -7.5 minutes.
TEST(SunPosition, AtNoonIsTheLatitudeLessTheDeclination) {
  SunTime time{
      .year = 2010, .month = 6, .day = 21, .hour = 12, .minute = 1.7, .latitude = 50, .longitude = 0, .timezone = 0};
  EXPECT_NEAR(sun_position(time).zenith_angle, (50 - 23.44) * k_degree, 0.02 * k_degree);
  EXPECT_NEAR(std::abs(sun_position(time).azimuth), std::numbers::pi, 0.2 * k_degree);
  time.month = 12, time.minute = -1.9;
  EXPECT_NEAR(sun_position(time).zenith_angle, (50 + 23.44) * k_degree, 0.02 * k_degree);
  time.month = 3, time.day = 20, time.hour = 17, time.minute = 32, time.longitude = -80.9, time.latitude = 0;
  EXPECT_NEAR(sun_position(time).zenith_angle, 0, 0.5 * k_degree);
}

TEST(SunPosition, IsEastInTheMorningAndWestInTheEvening) {
  SunTime time{.year = 2010, .month = 3, .day = 20, .latitude = 30, .longitude = 15, .timezone = 1};
  time.hour = 6.3;
  EXPECT_NEAR(sun_position(time).azimuth, 90 * k_degree, 3 * k_degree);
  EXPECT_NEAR(sun_position(time).zenith_angle, 90 * k_degree, 5 * k_degree);
  time.hour = 18;
  EXPECT_NEAR(sun_position(time).azimuth, -90 * k_degree, 3 * k_degree);
  const Vec3 west = sun_direction({.sun = sun_position(time)});
  EXPECT_LT(west.x, -0.9f);
  EXPECT_NEAR(position_of(west).zenith_angle, sun_position(time).zenith_angle, 1e-5);
}

}  // namespace
}  // namespace gradslc
