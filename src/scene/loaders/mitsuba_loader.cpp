#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "scene/loaders/loader.h"
#include "scene/loaders/mesh_list.h"
#include "scene/loaders/mitsuba_document.h"
#include "scene/loaders/mitsuba_emitters.h"
#include "scene/loaders/mitsuba_materials.h"
#include "scene/loaders/mitsuba_properties.h"
#include "scene/loaders/mitsuba_sensor.h"
#include "scene/loaders/mitsuba_shapes.h"
#include "scene/loaders/mitsuba_textures.h"

namespace gradslc {
namespace {

/// Turns the objects of a document into a scene.
class SceneBuilder {
 public:
  SceneBuilder(MitsubaDocument& document, const LoadOptions& options)
      : document_(document), options_(options), textures_(document), materials_(document, textures_) {}

  SceneDescription build() {
    for (const XmlElement& object : document_.objects()) add(object);
    if (!has_sensor_) document_.fail(document_.root(), "the scene has no <sensor>");
    scene_.materials = materials_.take_materials();
    scene_.material_names = materials_.take_names();
    scene_.meshes = meshes_.make(document_.root().document->file());
    scene_.notes = document_.notes();
    scene_.files = document_.files();
    return std::move(scene_);
  }

 private:
  void add(const XmlElement& object);
  void add_sensor(const XmlElement& sensor);
  void add_shape(const XmlElement& shape);
  std::optional<std::size_t> plan_mesh(const XmlElement& shape);
  void add_instance(const XmlElement& instance);
  const std::vector<std::size_t>& group_meshes(const XmlElement& group);
  const ShapeEntry* find_shape(const XmlElement& shape);
  std::int32_t add_area_light(const XmlElement& emitter);
  void add_light(const XmlElement& emitter);

  MitsubaDocument& document_;
  const LoadOptions& options_;
  MitsubaTextures textures_;
  MitsubaMaterials materials_;
  MeshList meshes_;
  std::map<pugi::xml_node, std::vector<std::size_t>> groups_;  // meshes of each shapegroup
  SceneDescription scene_;
  bool has_sensor_ = false;
};

void SceneBuilder::add(const XmlElement& object) {
  const std::string_view tag = object.node.name();
  if (tag == "shape") {
    add_shape(object);
  } else if (tag == "bsdf") {
    materials_.build(object);
  } else if (tag == "texture") {
    textures_.build(object);
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
  const std::string type = document_.required_attribute(shape, "type");
  if (type == k_shape_group) {
    group_meshes(shape);
  } else if (type == k_instance) {
    add_instance(shape);
  } else if (const auto mesh = plan_mesh(shape)) {
    meshes_.place(*mesh);
  }
}

/// nullptr where the shape is not recognised.
const ShapeEntry* SceneBuilder::find_shape(const XmlElement& shape) {
  const std::string type = document_.required_attribute(shape, "type");
  std::vector<std::string> names;
  for (const ShapeEntry& candidate : shape_registry()) {
    if (type == candidate.name) return &candidate;
    names.emplace_back(candidate.name);
  }
  document_.unknown(shape, fmt::format("unknown shape \"{}\"{}", type, suggestion(type, names)), "type");
  return nullptr;
}

/// A shape that is a mesh of its own; nullopt where it is not recognised.
std::optional<std::size_t> SceneBuilder::plan_mesh(const XmlElement& shape) {
  const ShapeEntry* const entry = find_shape(shape);
  if (!entry) return std::nullopt;
  MitsubaProperties properties(document_, shape);
  MeshList::Planned mesh{.shape = entry->plan(document_, properties), .name = properties.id()};
  if (mesh.name.empty()) mesh.name = fmt::format("{} at line {}", entry->name, document_.line(shape));

  const std::vector<XmlElement> bsdfs = properties.objects("bsdf");
  if (bsdfs.size() > 1) document_.fail(shape, fmt::format("a shape has one bsdf, not {}", bsdfs.size()));
  mesh.material = bsdfs.empty() ? materials_.default_index() : materials_.index(bsdfs[0]);
  const std::vector<XmlElement> emitters = properties.objects("emitter");
  if (emitters.size() > 1) document_.fail(shape, fmt::format("a shape has one emitter, not {}", emitters.size()));
  if (!emitters.empty()) mesh.area_light = add_area_light(emitters[0]);
  properties.finish();
  return meshes_.add(std::move(mesh));
}

/// Each group is read once, however many instances it has.
const std::vector<std::size_t>& SceneBuilder::group_meshes(const XmlElement& group) {
  const auto [entry, added] = groups_.try_emplace(group.node);
  if (!added) return entry->second;
  MitsubaProperties properties(document_, group);
  for (const XmlElement& shape : properties.objects("shape")) {
    const std::string type = document_.required_attribute(shape, "type");
    if (type == k_shape_group || type == k_instance)
      document_.fail(shape, fmt::format("a shapegroup cannot hold a shape \"{}\"", type), "type");
    if (!MitsubaProperties(document_, shape).objects("emitter").empty())
      document_.fail(shape, "a shape in a shapegroup cannot emit light");
    if (const auto mesh = plan_mesh(shape)) entry->second.push_back(*mesh);
  }
  properties.finish();
  return entry->second;
}

/// Instances are copies: their meshes stand in the scene as if they had been written there.
void SceneBuilder::add_instance(const XmlElement& instance) {
  MitsubaProperties properties(document_, instance);
  const Transform to_world = properties.transform("to_world");
  const std::vector<XmlElement> groups = properties.objects("shape");
  if (groups.size() != 1 || document_.required_attribute(groups[0], "type") != k_shape_group)
    document_.fail(instance, "an instance needs one <ref> to a shape \"shapegroup\"");
  properties.finish();
  std::string name = properties.id();
  if (name.empty()) name = fmt::format("instance at line {}", document_.line(instance));
  for (const std::size_t mesh : group_meshes(groups[0]))
    meshes_.place_copy(mesh, to_world, fmt::format("{} in {}", meshes_.name(mesh), name));
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
