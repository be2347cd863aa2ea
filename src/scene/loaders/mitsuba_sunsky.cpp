#include "scene/loaders/mitsuba_sunsky.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>

#include "scene/lights/directional.h"
#include "scene/lights/environment_map.h"
#include "scene/lights/sun_sky_map.h"
#include "scene/loaders/mitsuba_emitters.h"

namespace gradslc {
namespace {

constexpr float k_max_radius_scale = 300;  // the sun's disk then fills half the sky
constexpr int k_max_resolution = 16384;

bool has_z_up(MitsubaDocument& document, MitsubaProperties& properties) {
  return properties.plugin() == "sunsky" && !document.is_legacy(properties.element());
}

double in_range(MitsubaProperties& properties, const char* name, float default_value, float lowest, float highest) {
  const float value = properties.real(name, default_value);
  if (!(value >= lowest && value <= highest))
    properties.fail(name, fmt::format("{} must be from {} to {}, not {}", name, lowest, highest, value));
  return value;
}

/// From the map's space, +y up, -z north and +x east, to the world.
Orientation map_orientation(MitsubaDocument& document, MitsubaProperties& properties) {
  const Orientation given = read_orientation(properties);
  return has_z_up(document, properties) ? Orientation{given.x, given.z, -given.y} : given;
}

SunPosition position_by_time(MitsubaProperties& properties) {
  SunTime time;
  time.year = properties.integer("year", time.year);
  time.month = properties.integer("month", time.month);
  time.day = properties.integer("day", time.day);
  using std::chrono::year_month_day;
  const bool in_calendar = time.year >= 1 && time.year <= 9999 && time.month >= 1 && time.day >= 1;
  if (!in_calendar ||
      !year_month_day(std::chrono::year(time.year), std::chrono::month(static_cast<unsigned>(time.month)),
                      std::chrono::day(static_cast<unsigned>(time.day)))
           .ok())
    properties.fail("day", fmt::format("there is no date {}-{}-{}", time.year, time.month, time.day));
  const auto real = [&](const char* name, double default_value) {
    return static_cast<double>(properties.real(name, static_cast<float>(default_value)));
  };
  time.hour = real("hour", time.hour);
  time.minute = real("minute", time.minute);
  time.second = real("second", time.second);
  time.latitude = real("latitude", time.latitude);
  time.longitude = real("longitude", time.longitude);
  time.timezone = real("timezone", time.timezone);
  return sun_position(time);
}

SunPosition position_by_direction(MitsubaProperties& properties, const Orientation& orientation) {
  for (const char* name : {"year", "month", "day", "hour", "minute", "second", "latitude", "longitude", "timezone"})
    if (properties.has(name))
      properties.fail(name, fmt::format("give either sun_direction or time and place ({}), not both", name));
  const Vec3 local = orientation.to_local(unit_vector(properties, "sun_direction", {0, 1, 0}));
  return {std::atan2(std::hypot(local.x, local.z), local.y), std::atan2(local.x, -local.z)};
}

/// Parameters that sun and sky share; the sky's own ones where it has a part.
ClearSky read_clear_sky(MitsubaDocument& document, MitsubaProperties& properties, const Orientation& orientation,
                        bool with_sky) {
  ClearSky sky;
  sky.turbidity = in_range(properties, "turbidity", 3, 1, 10);
  sky.sun =
      properties.has("sun_direction") ? position_by_direction(properties, orientation) : position_by_time(properties);
  constexpr double rounding = 1e-6;
  if (sky.sun.zenith_angle > std::numbers::pi / 2 + rounding)
    properties.fail("sun_direction", "the sun is below the horizon: the model knows no night");
  sky.sun.zenith_angle = std::min(sky.sun.zenith_angle, std::numbers::pi / 2);
  sky.stretch = in_range(properties, "stretch", 1, 1, 2);
  if (!with_sky) return sky;
  // Mitsuba 0.6's manual says 0.15, the program has 0.2.
  sky.albedo = non_negative_colour(properties, "albedo", Rgb(document.is_legacy(properties.element()) ? 0.2f : 0.3f));
  if (max_channel(sky.albedo) > 1) properties.fail("albedo", "albedo must not be above 1");
  sky.extend = properties.boolean("extend", false);
  return sky;
}

RgbImage read_resolution(MitsubaProperties& properties) {
  const int resolution = properties.integer("resolution", 512);
  if (resolution < 2 || resolution > k_max_resolution)
    properties.fail("resolution", fmt::format("resolution must be from 2 to {}, not {}", k_max_resolution, resolution));
  return black_map(resolution);
}

float read_radius_scale(MitsubaDocument& document, MitsubaProperties& properties) {
  if (!has_z_up(document, properties))
    return static_cast<float>(in_range(properties, "sun_radius_scale", 1, 0, k_max_radius_scale));
  const double sun_diameter = 2 * k_sun_radius * 180 / std::numbers::pi;
  return static_cast<float>(in_range(properties, "sun_aperture", 0.5338f, 0, 90) / sun_diameter);
}

/// Adds the sun to the map or, where it has no radius, as a light of its own.
void place_sun(RgbImage& map, const ClearSky& sky, float scale, float radius_scale, const Orientation& orientation,
               std::vector<LightPtr>& lights) {
  if (radius_scale > 0) return add_sun(map, sky, scale, radius_scale);
  const Vec3 direction = orientation.to_world(-sun_direction(sky));
  lights.push_back(std::make_shared<const DirectionalLight>(direction, scale * sun_irradiance(sky)));
}

}  // namespace

std::vector<LightPtr> make_sun(MitsubaDocument& document, MitsubaProperties& properties) {
  const Orientation orientation = map_orientation(document, properties);
  const ClearSky sky = read_clear_sky(document, properties, orientation, false);
  const float scale = non_negative_real(properties, "scale", 1);
  RgbImage map = read_resolution(properties);
  std::vector<LightPtr> lights;
  place_sun(map, sky, scale, read_radius_scale(document, properties), orientation, lights);
  if (lights.empty()) lights.push_back(std::make_shared<const EnvironmentMap>(std::move(map), orientation, "sun"));
  return lights;
}

std::vector<LightPtr> make_sky(MitsubaDocument& document, MitsubaProperties& properties) {
  const Orientation orientation = map_orientation(document, properties);
  const ClearSky sky = read_clear_sky(document, properties, orientation, true);
  const float scale = non_negative_real(properties, "scale", 1);
  RgbImage map = read_resolution(properties);
  add_sky(map, sky, scale);
  return {std::make_shared<const EnvironmentMap>(std::move(map), orientation, "sky")};
}

std::vector<LightPtr> make_sunsky(MitsubaDocument& document, MitsubaProperties& properties) {
  const Orientation orientation = map_orientation(document, properties);
  const ClearSky sky = read_clear_sky(document, properties, orientation, true);
  const float scale = non_negative_real(properties, "scale", 1);
  const float sky_scale = non_negative_real(properties, "sky_scale", scale);
  const float sun_scale = non_negative_real(properties, "sun_scale", scale);
  RgbImage map = read_resolution(properties);
  std::vector<LightPtr> lights;
  add_sky(map, sky, sky_scale);
  place_sun(map, sky, sun_scale, read_radius_scale(document, properties), orientation, lights);
  if (has_z_up(document, properties))
    document.note(properties.element(), "sunsky: the sun is Preetham's as in Mitsuba 0.6, not that of Mitsuba 3");
  lights.push_back(std::make_shared<const EnvironmentMap>(std::move(map), orientation, "sunsky"));
  return lights;
}

}  // namespace gradslc
