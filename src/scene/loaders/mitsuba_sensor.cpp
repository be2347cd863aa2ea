#include "scene/loaders/mitsuba_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scene/loaders/mitsuba_properties.h"
#include "scene/loaders/mitsuba_values.h"

namespace gradslc {
namespace {

constexpr double k_axis_tolerance = 1e-3;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// The film as the scene file gives it, and the part of it that is the image.
struct Film {
  Resolution size{768, 576};
  int crop_x = 0, crop_y = 0;
  Resolution crop{768, 576};
};

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

/// A crop window's edges on one axis, moved to a film of another size; at least one pixel.
struct Span {
  int begin, size;
};
Span scaled(Span span, int film, int new_film) {
  const auto edge = [&](int at) { return static_cast<int>(std::lround(static_cast<double>(at) * new_film / film)); };
  const int begin = std::min(edge(span.begin), new_film - 1);
  return {begin, std::max(edge(span.begin + span.size) - begin, 1)};
}

/// LoadOptions' width and height are those of the whole film; the crop window keeps its place on it.
Film overridden(const Film& film, const LoadOptions& options) {
  const Resolution size = overridden(film.size, options);
  const Span x = scaled({film.crop_x, film.crop.width}, film.size.width, size.width);
  const Span y = scaled({film.crop_y, film.crop.height}, film.size.height, size.height);
  return {.size = size, .crop_x = x.begin, .crop_y = y.begin, .crop = {x.size, y.size}};
}

Span read_crop(MitsubaProperties& film, const char* offset_name, const char* size_name, int full) {
  const Span crop{film.integer(offset_name, 0), film.integer(size_name, full)};
  if (crop.begin < 0 || crop.begin >= full)
    film.fail(offset_name, fmt::format("{} must be from 0 to {}, not {}", offset_name, full - 1, crop.begin));
  if (crop.size < 1 || crop.size > full - crop.begin)
    film.fail(size_name, fmt::format("{} must be from 1 to {}, the rest of the film, not {}", size_name,
                                     full - crop.begin, crop.size));
  return crop;
}

Film read_film(MitsubaDocument& document, const XmlElement& element) {
  MitsubaProperties properties(document, element);
  if (const std::string& type = properties.plugin(); type != "hdrfilm" && type != "ldrfilm" && type != "mfilm")
    document.note(element, fmt::format("film \"{}\" has no effect but for its size", type));
  Film film;
  film.size.width = properties.integer("width", 768);
  film.size.height = properties.integer("height", 576);
  for (const auto& [name, value] : {std::pair{"width", film.size.width}, std::pair{"height", film.size.height}})
    if (value < 1 || value > k_max_film_size)
      properties.fail(name, fmt::format("film {} must be from 1 to {}, not {}", name, k_max_film_size, value));
  const Span x = read_crop(properties, "crop_offset_x", "crop_width", film.size.width);
  const Span y = read_crop(properties, "crop_offset_y", "crop_height", film.size.height);
  film.crop_x = x.begin, film.crop_y = y.begin;
  film.crop = {x.size, y.size};
  for (const char* name :
       {"file_format", "pixel_format", "component_format", "gamma", "banner", "exposure", "tonemap_method", "key",
        "burn", "high_quality_edges", "attach_log", "sample_border", "compensate", "digits", "variable"})
    properties.ignore(name);
  for (const XmlElement& filter : properties.objects("rfilter"))
    if (const std::string type = document.attribute(filter, "type"); type != "box")
      document.note(filter, fmt::format("reconstruction filter \"{}\" has no effect: pixels are averaged (box)", type));
  properties.finish();
  return film;
}

/// Tangent of half the horizontal field of view of the whole film. `aspect` = width / height.
double half_width(MitsubaProperties& sensor, double aspect) {
  if (sensor.has("fov") && sensor.has("focal_length"))
    sensor.fail("focal_length", "give either fov or focal_length, not both");
  double fov = sensor.real("fov", 0);
  std::string axis = sensor.text("fov_axis", "x");
  if (!sensor.has("fov")) {  // the focal length of a 35 mm camera, whose film measures 36 x 24 mm
    std::string text = sensor.text("focal_length", "50mm");
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const auto millimetres = parse_number(text);
    if (!millimetres || !(*millimetres > 0))
      sensor.fail("focal_length", "focal_length must be a positive length, as in \"50mm\"");
    fov = 2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / (2 * *millimetres)) * 180 / std::numbers::pi;
    axis = "diagonal";
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

/// Mitsuba moves the film against the axis by the principal point's offset, a fraction of the film's size.
ImageWindow image_window(MitsubaProperties& sensor, const Film& film) {
  const double width = film.size.width, height = film.size.height;
  const double half_x = half_width(sensor, width / height), half_y = half_x * height / width;
  const double shift_x = sensor.real("principal_point_offset_x", 0);
  const double shift_y = sensor.real("principal_point_offset_y", 0);
  const auto at = [&](int x, int y) {
    return Vec2{static_cast<float>(half_x * (2 * (x / width + shift_x) - 1)),
                static_cast<float>(half_y * (1 - 2 * (y / height + shift_y)))};
  };
  return {at(film.crop_x, film.crop_y), at(film.crop_x + film.crop.width, film.crop_y + film.crop.height)};
}

/// In scene units, whatever scale the sensor's transform has.
ThinLens read_lens(MitsubaProperties& sensor) {
  if (!sensor.has("aperture_radius")) sensor.fail("", "a thinlens sensor needs aperture_radius");
  ThinLens lens;
  lens.radius = sensor.real("aperture_radius", 0);
  lens.focus_distance = sensor.real("focus_distance", sensor.real("far_clip", 10000));
  if (!(lens.radius >= 0))
    sensor.fail("aperture_radius", fmt::format("aperture_radius must not be negative, is {}", lens.radius));
  if (!(lens.focus_distance > 0))
    sensor.fail("focus_distance", fmt::format("focus_distance must be above 0, not {}", lens.focus_distance));
  return lens;
}

PerspectiveCamera place(MitsubaProperties& sensor, Resolution resolution, const ImageWindow& window,
                        const ThinLens& lens) {
  const Transform to_world = sensor.transform("to_world");
  const Vec3 x = to_world.column(0), y = to_world.column(1), z = to_world.column(2);
  const float lengths[3] = {length(x), length(y), length(z)};
  const auto [shortest, longest] = std::minmax_element(lengths, lengths + 3);
  if (!(*shortest > 0) || *longest - *shortest > k_axis_tolerance * *longest)
    sensor.fail("to_world", "the sensor's transform must not scale its axes differently");
  const Vec3 left = normalize(x), up = normalize(y), forward = normalize(z);
  if (std::max({std::abs(dot(left, up)), std::abs(dot(up, forward)), std::abs(dot(forward, left))}) > k_axis_tolerance)
    sensor.fail("to_world", "the sensor's transform must not shear");
  return {resolution, Point3() + to_world.column(3), forward, -left, up, window, lens};
}

}  // namespace

PerspectiveCamera read_sensor(MitsubaDocument& document, const XmlElement& element, const LoadOptions& options) {
  MitsubaProperties sensor(document, element);
  const bool has_lens = sensor.plugin() == "thinlens";
  if (!has_lens && sensor.plugin() != "perspective")
    document.fail(element,
                  fmt::format("unknown sensor \"{}\"{}", sensor.plugin(),
                              suggestion(sensor.plugin(), std::array<std::string, 2>{"perspective", "thinlens"})),
                  "type");
  const std::vector<XmlElement> films = sensor.objects("film");
  if (films.size() > 1) document.fail(films[1], "a sensor has one film");
  const Film film = overridden(films.empty() ? Film() : read_film(document, films[0]), options);
  const ImageWindow window = image_window(sensor, film);
  const ThinLens lens = has_lens ? read_lens(sensor) : ThinLens();
  const PerspectiveCamera camera = place(sensor, film.crop, window, lens);
  for (const char* name : {"near_clip", "shutter_open", "shutter_close"}) sensor.ignore(name);
  if (!has_lens) sensor.ignore("focus_distance");
  if (!has_lens || sensor.has("focus_distance")) sensor.ignore("far_clip");
  for (const XmlElement& sampler : sensor.objects("sampler"))
    document.note(sampler, fmt::format("sampler \"{}\" has no effect: the experiment chooses sampler and samples",
                                       document.attribute(sampler, "type")));
  sensor.finish();
  return camera;
}

}  // namespace gradslc
