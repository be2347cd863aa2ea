#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "scene/loaders/loader.h"
#include "scene/loaders/mitsuba_document.h"
#include "scene/loaders/mitsuba_emitters.h"
#include "scene/loaders/mitsuba_materials.h"
#include "scene/loaders/mitsuba_properties.h"
#include "scene/loaders/mitsuba_sensor.h"
#include "scene/loaders/mitsuba_shapes.h"

namespace gradslc {
namespace {

/// Turns the objects of a document into a scene.
class SceneBuilder {
 public:
  SceneBuilder(MitsubaDocument& document, const LoadOptions& options)
      : document_(document), options_(options), materials_(document) {}

  SceneDescription build() {
    for (const XmlElement& object : document_.objects()) add(object);
    if (!has_sensor_) document_.fail(document_.root(), "the scene has no <sensor>");
    scene_.materials = materials_.take_materials();
    scene_.material_names = materials_.take_names();
    scene_.notes = document_.notes();
    return std::move(scene_);
  }

 private:
  void add(const XmlElement& object);
  void add_sensor(const XmlElement& sensor);
  void add_shape(const XmlElement& shape);
  std::int32_t add_area_light(const XmlElement& emitter);
  void add_light(const XmlElement& emitter);

  MitsubaDocument& document_;
  const LoadOptions& options_;
  MitsubaMaterials materials_;
  SceneDescription scene_;
  bool has_sensor_ = false;
};

void SceneBuilder::add(const XmlElement& object) {
  const std::string_view tag = object.node.name();
  if (tag == "shape") {
    add_shape(object);
  } else if (tag == "bsdf") {
    materials_.build(object);
  } else if (tag == "sensor") {
    add_sensor(object);
  } else if (tag == "integrator") {
    document_.note(object, fmt::format("integrator \"{}\" has no effect: the experiment chooses the method",
                                       document_.attribute(object, "type")));
  } else if (tag == "emitter" && document_.attribute(object, "type") == "area") {
    if (!object.node.attribute("id")) document_.fail(object, "an area emitter must stand inside a <shape>");
  } else if (tag == "emitter") {
    add_light(object);
  } else {
    document_.unknown(object, fmt::format("unknown element <{}> in <scene>", tag));
  }
}

void SceneBuilder::add_sensor(const XmlElement& sensor) {
  if (has_sensor_) return document_.note(sensor, "only the first sensor is used");
  scene_.camera = read_sensor(document_, sensor, options_);
  has_sensor_ = true;
}

void SceneBuilder::add_shape(const XmlElement& shape) {
  MitsubaProperties properties(document_, shape);
  const auto registry = shape_registry();
  const auto entry = std::find_if(registry.begin(), registry.end(),
                                  [&](const ShapeEntry& candidate) { return properties.plugin() == candidate.name; });
  if (entry == registry.end()) {
    std::vector<std::string> names;
    for (const ShapeEntry& candidate : registry) names.emplace_back(candidate.name);
    return document_.unknown(
        shape, fmt::format("unknown shape \"{}\"{}", properties.plugin(), suggestion(properties.plugin(), names)),
        "type");
  }
  TriangleMesh mesh = entry->make(document_, properties);
  mesh.name = properties.id();
  if (mesh.name.empty()) mesh.name = fmt::format("{} at line {}", entry->name, document_.line(shape));

  const std::vector<XmlElement> bsdfs = properties.objects("bsdf");
  if (bsdfs.size() > 1) document_.fail(shape, fmt::format("a shape has one bsdf, not {}", bsdfs.size()));
  mesh.material = bsdfs.empty() ? materials_.default_index() : materials_.index(bsdfs[0]);
  const std::vector<XmlElement> emitters = properties.objects("emitter");
  if (emitters.size() > 1) document_.fail(shape, fmt::format("a shape has one emitter, not {}", emitters.size()));
  if (!emitters.empty()) mesh.area_light = add_area_light(emitters[0]);
  properties.finish();
  scene_.meshes.push_back(std::move(mesh));
}

/// Index of the light, or -1 where it is not recognised.
std::int32_t SceneBuilder::add_area_light(const XmlElement& emitter) {
  MitsubaProperties properties(document_, emitter);
  if (properties.plugin() != "area") {
    document_.unknown(emitter, fmt::format("unknown emitter \"{}\" in a shape; known: area", properties.plugin()),
                      "type");
    return -1;
  }
  const Rgb radiance = properties.colour("radiance", Rgb(1));
  if (std::min({radiance.r, radiance.g, radiance.b}) < 0) properties.fail("radiance", "radiance must not be negative");
  properties.ignore("sampling_weight");
  properties.finish();
  scene_.area_lights.push_back({radiance});
  return static_cast<std::int32_t>(scene_.area_lights.size() - 1);
}

void SceneBuilder::add_light(const XmlElement& emitter) {
  MitsubaProperties properties(document_, emitter);
  const auto registry = light_registry();
  const auto entry = std::find_if(registry.begin(), registry.end(),
                                  [&](const LightEntry& candidate) { return properties.plugin() == candidate.name; });
  if (entry == registry.end()) {
    std::vector<std::string> names{"area"};
    for (const LightEntry& candidate : registry) names.emplace_back(candidate.name);
    return document_.unknown(
        emitter, fmt::format("unknown emitter \"{}\"{}", properties.plugin(), suggestion(properties.plugin(), names)),
        "type");
  }
  for (LightPtr& light : entry->make(document_, properties)) scene_.lights.push_back(std::move(light));
  properties.ignore("sampling_weight");
  properties.finish();
}

void check_options(const std::string& file, const LoadOptions& options) {
  for (const std::optional<int>& size : {options.width, options.height})
    if (size && (*size < 1 || *size > k_max_film_size))
      throw_input_error(
          file, fmt::format("the image's width and height must be from 1 to {}, not {}", k_max_film_size, *size));
}

}  // namespace

SceneDescription load_scene(const std::string& file, const LoadOptions& options) {
  check_options(file, options);
  MitsubaDocument document(file, options);
  return SceneBuilder(document, options).build();
}

SceneDescription load_scene_text(std::string text, const std::string& file, const LoadOptions& options) {
  check_options(file, options);
  MitsubaDocument document(file, std::move(text), options);
  return SceneBuilder(document, options).build();
}

}  // namespace gradslc
