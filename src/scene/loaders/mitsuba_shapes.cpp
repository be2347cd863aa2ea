#include "scene/loaders/mitsuba_shapes.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "core/frame.h"
#include "scene/loaders/obj.h"
#include "scene/loaders/placement.h"
#include "scene/loaders/ply.h"
#include "scene/loaders/polyhedra.h"
#include "scene/loaders/quadrics.h"
#include "scene/loaders/serialized.h"

namespace gradslc {
namespace {

/// A shape of known form, moved by `to_object` and then by the property to_world.
ShapePlan plan_known(MitsubaProperties& properties, TriangleMesh (*unit_shape)(), const Transform& to_object = {}) {
  const Transform to_world = properties.transform("to_world") * to_object;
  const bool flip = properties.boolean("flip_normals", false);
  return {.make = [=] {
    TriangleMesh mesh = unit_shape();
    place(mesh, to_world, flip);
    return mesh;
  }};
}

float read_radius(MitsubaProperties& properties) {
  const float radius = properties.real("radius", 1);
  if (!(radius > 0)) properties.fail("radius", fmt::format("radius must be above 0, not {}", radius));
  return radius;
}

ShapePlan plan_rectangle(MitsubaDocument&, MitsubaProperties& properties) {
  return plan_known(properties, unit_rectangle);
}

ShapePlan plan_cube(MitsubaDocument&, MitsubaProperties& properties) { return plan_known(properties, unit_cube); }

ShapePlan plan_disk(MitsubaDocument&, MitsubaProperties& properties) { return plan_known(properties, unit_disk); }

ShapePlan plan_sphere(MitsubaDocument&, MitsubaProperties& properties) {
  const Point3 c = properties.point("center", {0, 0, 0});
  const float radius = read_radius(properties);
  return plan_known(properties, unit_sphere,
                    Transform::translation(c.x, c.y, c.z) * Transform::scaling(radius, radius, radius));
}

ShapePlan plan_cylinder(MitsubaDocument&, MitsubaProperties& properties) {
  const Point3 p0 = properties.point("p0", {0, 0, 0}), p1 = properties.point("p1", {0, 0, 1});
  const float radius = read_radius(properties), height = distance(p0, p1);
  if (!(height > 0)) properties.fail("p1", "p0 and p1 must differ");
  const Frame frame = frame_from_normal(as_normal((p1 - p0) / height));
  const Vec3 x = radius * frame.s, y = radius * frame.t, z = p1 - p0;
  return plan_known(properties, unit_cylinder,
                    Transform({{{x.x, y.x, z.x, p0.x}, {x.y, y.y, z.y, p0.y}, {x.z, y.z, z.z, p0.z}}}));
}

MeshFileOptions read_options(MitsubaProperties& properties, bool flip_tex_coords) {
  MeshFileOptions options{.to_world = properties.transform("to_world"),
                          .face_normals = properties.boolean("face_normals", false),
                          .flip_tex_coords = properties.boolean("flip_tex_coords", flip_tex_coords),
                          .max_smooth_angle = {}};
  if (properties.has("max_smooth_angle")) {
    const float angle = properties.real("max_smooth_angle", 0);
    if (!(angle >= 0 && angle <= 180))
      properties.fail("max_smooth_angle", fmt::format("max_smooth_angle must be from 0 to 180 degrees, not {}", angle));
    options.max_smooth_angle = angle;
  }
  return options;
}

std::filesystem::path read_filename(MitsubaDocument& document, MitsubaProperties& properties) {
  const std::string name = properties.text("filename", "");
  if (name.empty()) properties.fail("filename", fmt::format("the shape \"{}\" needs a filename", properties.plugin()));
  std::filesystem::path file = document.resolve_path(properties.element(), name);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    properties.fail("filename", fmt::format("file \"{}\" does not exist", file.string()));
  document.add_file(file);
  return file;
}

/// A shape that `load(file, options)` reads.
template <class Load>
ShapePlan plan_file(MitsubaDocument& document, MitsubaProperties& properties, bool flip_tex_coords, const Load& load) {
  const std::filesystem::path file = read_filename(document, properties);
  const MeshFileOptions options = read_options(properties, flip_tex_coords);
  const bool flip = properties.boolean("flip_normals", false);
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  return {.make =
              [=] {
                TriangleMesh mesh = load(file, options);
                if (flip) flip_sides(mesh);
                return mesh;
              },
          .bytes = failure ? 0 : bytes};
}

ShapePlan plan_obj(MitsubaDocument& document, MitsubaProperties& properties) {
  properties.ignore("collapse");  // all groups are one mesh anyway
  return plan_file(document, properties, true, load_obj);
}

ShapePlan plan_ply(MitsubaDocument& document, MitsubaProperties& properties) {
  properties.ignore("srgb");  // of vertex colours, which are not read
  return plan_file(document, properties, false, load_ply);
}

ShapePlan plan_serialized(MitsubaDocument& document, MitsubaProperties& properties) {
  const int index = properties.integer("shape_index", 0);
  if (index < 0) properties.fail("shape_index", fmt::format("shape_index must not be negative, is {}", index));
  return plan_file(document, properties, false,
                   [index](const std::filesystem::path& file, const MeshFileOptions& options) {
                     return load_serialized(file, index, options);
                   });
}

constexpr ShapeEntry k_shapes[] = {
    {"rectangle", "the square [-1,1]^2 at z = 0, normal +z", plan_rectangle},
    {"cube", "the surface of [-1,1]^3, normals outwards", plan_cube},
    {"sphere", "by center and radius, in triangles", plan_sphere},
    {"disk", "the unit disk at z = 0, normal +z, in triangles", plan_disk},
    {"cylinder", "from p0 to p1 with a radius, without caps, in triangles", plan_cylinder},
    {"obj", "the polygons of a Wavefront OBJ file", plan_obj},
    {"ply", "the polygons of a PLY file", plan_ply},
    {"serialized", "a mesh of a Mitsuba .serialized file", plan_serialized},
    {k_shape_group, "shapes that are seen only where an instance places them", nullptr},
    {k_instance, "a copy of a shapegroup, moved by to_world", nullptr},
};

}  // namespace

std::span<const ShapeEntry> shape_registry() { return k_shapes; }

}  // namespace gradslc
