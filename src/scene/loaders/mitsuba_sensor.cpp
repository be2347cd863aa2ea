#include "scene/loaders/mitsuba_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/loaders/mitsuba_properties.h"
#include "scene/loaders/mitsuba_values.h"

namespace gradslc {
namespace {

constexpr double k_axis_tolerance = 1e-3;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

int scaled(int size, int numerator, int denominator) {
  return std::clamp(static_cast<int>(std::lround(static_cast<double>(size) * numerator / denominator)), 1,
                    k_max_film_size);
}

Resolution overridden(Resolution film, const LoadOptions& options) {
  if (options.width && options.height) return {*options.width, *options.height};
  if (options.width) return {*options.width, scaled(film.height, *options.width, film.width)};
  if (options.height) return {scaled(film.width, *options.height, film.height), *options.height};
  return film;
}

void check_crop(MitsubaProperties& film, Resolution size) {
  const auto check = [&](const char* name, int full) {
    if (film.integer(name, full) != full) film.fail(name, "crop windows are not supported: the whole film is rendered");
  };
  check("crop_offset_x", 0);
  check("crop_offset_y", 0);
  check("crop_width", size.width);
  check("crop_height", size.height);
}

Resolution read_film(MitsubaDocument& document, const XmlElement& element) {
  MitsubaProperties film(document, element);
  if (film.plugin() != "hdrfilm" && film.plugin() != "ldrfilm")
    document.note(element, fmt::format("film \"{}\" has no effect but for its size", film.plugin()));
  Resolution size;
  size.width = film.integer("width", 768);
  size.height = film.integer("height", 576);
  for (const auto& [name, value] : {std::pair{"width", size.width}, std::pair{"height", size.height}})
    if (value < 1 || value > k_max_film_size)
      film.fail(name, fmt::format("film {} must be from 1 to {}, not {}", name, k_max_film_size, value));
  check_crop(film, size);
  for (const char* name :
       {"file_format", "pixel_format", "component_format", "gamma", "banner", "exposure", "tonemap_method", "key",
        "burn", "high_quality_edges", "attach_log", "sample_border", "compensate"})
    film.ignore(name);
  for (const XmlElement& filter : film.objects("rfilter"))
    if (const std::string type = document.attribute(filter, "type"); type != "box")
      document.note(filter, fmt::format("reconstruction filter \"{}\" has no effect: pixels are averaged (box)", type));
  film.finish();
  return size;
}

/// Tangent of half the horizontal field of view. `aspect` = width / height.
double half_width(MitsubaProperties& sensor, double aspect) {
  double fov = 0;
  std::string axis = sensor.text("fov_axis", "x");
  if (sensor.has("focal_length")) {  // of a 35 mm camera, whose film measures 36 x 24 mm
    std::string text = sensor.text("focal_length", "50mm");
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const auto millimetres = parse_number(text);
    if (!millimetres || !(*millimetres > 0))
      sensor.fail("focal_length", "focal_length must be a positive length, as in \"50mm\"");
    if (sensor.has("fov")) sensor.fail("focal_length", "give either fov or focal_length, not both");
    fov = 2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / (2 * *millimetres)) * 180 / std::numbers::pi;
    axis = "diagonal";
  } else if (sensor.has("fov")) {
    fov = sensor.real("fov", 0);
  } else {
    sensor.fail("", "a perspective sensor needs fov (degrees) or focal_length");
  }
  if (!(fov > 0 && fov < 180))
    sensor.fail("fov", fmt::format("fov must be above 0 and below 180 degrees, not {}", fov));
  const double tangent = std::tan(radians(fov) / 2);
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return tangent;
  if (axis == "y") return tangent * aspect;
  if (axis == "diagonal") return tangent / std::sqrt(1 + 1 / (aspect * aspect));
  sensor.fail("fov_axis", fmt::format("unknown fov_axis \"{}\"; known: x, y, diagonal, smaller, larger", axis));
}

PerspectiveCamera place(MitsubaProperties& sensor, Resolution resolution, double tan_half_x) {
  const Transform to_world = sensor.transform("to_world");
  const Vec3 x = to_world.column(0), y = to_world.column(1), z = to_world.column(2);
  const float lengths[3] = {length(x), length(y), length(z)};
  const auto [shortest, longest] = std::minmax_element(lengths, lengths + 3);
  if (!(*shortest > 0) || *longest - *shortest > k_axis_tolerance * *longest)
    sensor.fail("to_world", "the sensor's transform must not scale its axes differently");
  const Vec3 left = normalize(x), up = normalize(y), forward = normalize(z);
  if (std::max({std::abs(dot(left, up)), std::abs(dot(up, forward)), std::abs(dot(forward, left))}) > k_axis_tolerance)
    sensor.fail("to_world", "the sensor's transform must not shear");
  const double tan_half_y = tan_half_x * resolution.height / resolution.width;
  return {resolution,
          Point3() + to_world.column(3),
          forward,
          -left,
          up,
          static_cast<float>(tan_half_x),
          static_cast<float>(tan_half_y)};
}

}  // namespace

PerspectiveCamera read_sensor(MitsubaDocument& document, const XmlElement& element, const LoadOptions& options) {
  MitsubaProperties sensor(document, element);
  if (sensor.plugin() != "perspective")
    document.fail(element, fmt::format("unknown sensor \"{}\"; known: perspective", sensor.plugin()), "type");
  const std::vector<XmlElement> films = sensor.objects("film");
  if (films.size() > 1) document.fail(films[1], "a sensor has one film");
  const Resolution film = films.empty() ? Resolution{768, 576} : read_film(document, films[0]);
  const Resolution resolution = overridden(film, options);
  const double aspect = static_cast<double>(resolution.width) / resolution.height;
  const PerspectiveCamera camera = place(sensor, resolution, half_width(sensor, aspect));
  for (const char* name : {"principal_point_offset_x", "principal_point_offset_y"})
    if (sensor.real(name, 0) != 0) sensor.fail(name, fmt::format("{} is not supported", name));
  for (const char* name : {"near_clip", "far_clip", "focus_distance", "shutter_open", "shutter_close"})
    sensor.ignore(name);
  for (const XmlElement& sampler : sensor.objects("sampler"))
    document.note(sampler, fmt::format("sampler \"{}\" has no effect: the experiment chooses sampler and samples",
                                       document.attribute(sampler, "type")));
  sensor.finish();
  return camera;
}

}  // namespace gradslc
