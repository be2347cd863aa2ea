#include "scene/loaders/mitsuba_emitters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "scene/lights/constant.h"
#include "scene/lights/directional.h"
#include "scene/lights/environment_map.h"
#include "scene/lights/point.h"
#include "scene/lights/spot.h"
#include "scene/loaders/images.h"
#include "scene/loaders/mitsuba_sunsky.h"

namespace gradslc {
namespace {

constexpr float k_axis_tolerance = 1e-3f;

/// Where the light's origin comes to lie.
Point3 read_position(MitsubaProperties& properties) {
  if (!properties.has("position")) return Point3() + properties.transform("to_world").column(3);
  if (properties.has("to_world")) properties.fail("position", "give either position or to_world, not both");
  return Point3() + properties.vector("position", Vec3());
}

std::vector<LightPtr> make_constant(MitsubaDocument& /*document*/, MitsubaProperties& properties) {
  return {std::make_shared<const ConstantLight>(non_negative_colour(properties, "radiance", Rgb(1)))};
}

std::vector<LightPtr> make_point(MitsubaDocument& /*document*/, MitsubaProperties& properties) {
  const Point3 position = read_position(properties);
  return {std::make_shared<const PointLight>(position, non_negative_colour(properties, "intensity", Rgb(1)))};
}

std::vector<LightPtr> make_spot(MitsubaDocument& /*document*/, MitsubaProperties& properties) {
  const float cutoff = properties.real("cutoff_angle", 20);
  if (!(cutoff > 0 && cutoff <= 180))
    properties.fail("cutoff_angle",
                    fmt::format("cutoff_angle must be above 0 and at most 180 degrees, not {}", cutoff));
  const float beam = properties.real("beam_width", cutoff * 3 / 4);
  if (!(beam >= 0 && beam <= cutoff))
    properties.fail("beam_width", fmt::format("beam_width must be from 0 to cutoff_angle ({}), not {}", cutoff, beam));
  const Point3 position = Point3() + properties.transform("to_world").column(3);
  constexpr float degree = k_pi / 180;
  return {std::make_shared<const SpotLight>(position, read_orientation(properties).z,
                                            non_negative_colour(properties, "intensity", Rgb(1)), cutoff * degree,
                                            beam * degree)};
}

std::vector<LightPtr> make_directional(MitsubaDocument& /*document*/, MitsubaProperties& properties) {
  if (properties.has("direction") && properties.has("to_world"))
    properties.fail("direction", "give either direction or to_world, not both");
  const Vec3 direction =
      properties.has("direction") ? unit_vector(properties, "direction", {0, 0, 1}) : read_orientation(properties).z;
  return {std::make_shared<const DirectionalLight>(direction, non_negative_colour(properties, "irradiance", Rgb(1)))};
}

/// Scales a map; what is negative, as filters leave it, becomes 0 and is noted. What is not finite is an error.
void scale_radiance(RgbImage& map, float scale, MitsubaDocument& document, MitsubaProperties& properties) {
  std::size_t negative = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    Rgb& texel = map[i];
    if (std::min({texel.r, texel.g, texel.b}) < 0) ++negative;
    texel = scale * Rgb(std::max(texel.r, 0.0f), std::max(texel.g, 0.0f), std::max(texel.b, 0.0f));
    if (!is_finite(texel)) {
      const Pixel at = map.resolution().pixel(i);
      properties.fail("filename", fmt::format("texel ({}, {}) of the map is not finite", at.x, at.y));
    }
  }
  if (negative > 0)
    document.note(properties.element(),
                  fmt::format("{} texels of the map are negative in a channel: taken as 0", negative));
}

std::vector<LightPtr> make_envmap(MitsubaDocument& document, MitsubaProperties& properties) {
  const std::string filename = properties.text("filename", "");
  if (filename.empty()) properties.fail("filename", "an envmap needs a filename");
  const std::filesystem::path path = document.resolve_path(properties.element(), filename);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    properties.fail("filename", fmt::format("file \"{}\" does not exist", path.string()));
  document.add_file(path);
  const float scale = non_negative_real(properties, "scale", 1);
  const Orientation orientation = read_orientation(properties);
  for (const char* name : {"gamma", "cache", "mis_compensation"}) properties.ignore(name);
  RgbImage map = linear_rgb(read_image(path));
  scale_radiance(map, scale, document, properties);
  auto light = std::make_shared<const EnvironmentMap>(std::move(map), orientation);
  if (!is_finite(light->integral())) properties.fail("filename", "the map is too bright: its integral is not finite");
  return {std::move(light)};
}

constexpr LightEntry k_lights[] = {
    {"constant", "the same radiance from all directions", make_constant},
    {"envmap", "radiance from infinity by a latitude-longitude image", make_envmap},
    {"point", "a point with the same intensity in all directions", make_point},
    {"spot", "a point that shines into a cone", make_spot},
    {"directional", "parallel light", make_directional},
    {"sun", "the sun's disk in a clear sky", make_sun},
    {"sky", "a clear sky without the sun's disk", make_sky},
    {"sunsky", "sun and clear sky", make_sunsky},
};

}  // namespace

std::span<const LightEntry> light_registry() { return k_lights; }

Rgb non_negative_colour(MitsubaProperties& properties, const char* name, Rgb default_value) {
  const Rgb colour = properties.colour(name, default_value);
  if (std::min({colour.r, colour.g, colour.b}) < 0) properties.fail(name, fmt::format("{} must not be negative", name));
  return colour;
}

float non_negative_real(MitsubaProperties& properties, const char* name, float default_value) {
  const float value = properties.real(name, default_value);
  if (!(value >= 0)) properties.fail(name, fmt::format("{} must not be negative", name));
  return value;
}

Orientation read_orientation(MitsubaProperties& properties) {
  const Transform to_world = properties.transform("to_world");
  const Vec3 columns[3] = {to_world.column(0), to_world.column(1), to_world.column(2)};
  const float lengths[3] = {length(columns[0]), length(columns[1]), length(columns[2])};
  const auto [shortest, longest] = std::minmax_element(lengths, lengths + 3);
  if (!(*shortest > 0) || *longest - *shortest > k_axis_tolerance * *longest)
    properties.fail("to_world", "the emitter's transform must not scale its axes differently");
  const Vec3 y = columns[1] / lengths[1], z = columns[2] / lengths[2];
  if (std::max({std::abs(dot(columns[0], y)), std::abs(dot(columns[0], z)), std::abs(dot(columns[1], z))}) >
      k_axis_tolerance * *longest)
    properties.fail("to_world", "the emitter's transform must not shear");
  const Vec3 upright_z = normalize(z - dot(z, y) * y);
  const Vec3 x = cross(y, upright_z);
  return {to_world.determinant() < 0 ? -x : x, y, upright_z};
}

Vec3 unit_vector(MitsubaProperties& properties, const char* name, Vec3 default_value) {
  const Vec3 vector = properties.vector(name, default_value);
  const float longest = max_component(abs(vector));  // a length's square might over- or underflow
  if (!(longest > 0)) properties.fail(name, fmt::format("{} must not be zero", name));
  return normalize(vector / longest);
}

}  // namespace gradslc
