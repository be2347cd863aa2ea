#include "scene/loaders/mitsuba_shapes.h"

#include <array>
#include <filesystem>
#include <system_error>

#include "scene/loaders/obj.h"

namespace gradslc {
namespace {

constexpr std::array<Vec2, 4> k_corner_uvs = {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};

/// Adds the four corners of a square face and its two triangles, (0,1,2) and (2,3,0).
void add_face(TriangleMesh& mesh, const std::array<Point3, 4>& corners, const std::array<Vec2, 4>& uvs,
              Normal3 normal) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
  mesh.normals.insert(mesh.normals.end(), 4, normal);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first + 2, first + 3, first});
}

/// Moves a shape to the world. Normals go by the inverse transpose, so a mirroring map keeps their side although it
/// turns the winding round.
void place(TriangleMesh& mesh, MitsubaProperties& properties) {
  const Transform to_world = properties.transform("to_world");
  const bool flip = properties.boolean("flip_normals", false);
  for (Point3& position : mesh.positions) position = to_world.apply(position);
  for (Normal3& normal : mesh.normals) normal = to_world.apply(normal);
  mesh.flip_normals = flip != (to_world.determinant() < 0);
}

TriangleMesh make_rectangle(MitsubaDocument&, MitsubaProperties& properties) {
  TriangleMesh mesh;
  add_face(mesh, {Point3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, k_corner_uvs, {0, 0, 1});
  place(mesh, properties);
  mesh.normals.clear();  // flat
  return mesh;
}

/// Mitsuba's cube maps each face onto [0,1]^2: u grows along `right` and v against `up`, with right x up the normal.
TriangleMesh make_cube(MitsubaDocument&, MitsubaProperties& properties) {
  struct Face {
    Vec3 right, up;
  };
  constexpr Face k_faces[] = {{{0, 0, 1}, {-1, 0, 0}}, {{-1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}},
                              {{0, 1, 0}, {-1, 0, 0}}, {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {-1, 0, 0}}};
  TriangleMesh mesh;
  for (const auto& [right, up] : k_faces) {
    const Vec3 normal = cross(right, up);
    const Point3 centre = Point3() + normal;
    add_face(mesh, {centre - right - up, centre + right - up, centre + right + up, centre - right + up},
             {Vec2{0, 1}, Vec2{1, 1}, Vec2{1, 0}, Vec2{0, 0}}, as_normal(normal));
  }
  place(mesh, properties);
  mesh.normals.clear();  // flat
  return mesh;
}

TriangleMesh make_obj(MitsubaDocument& document, MitsubaProperties& properties) {
  const std::string name = properties.text("filename", "");
  if (name.empty()) properties.fail("filename", "an obj shape needs a filename");
  const std::filesystem::path file = document.resolve_path(properties.element(), name);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    properties.fail("filename", "file \"" + file.string() + "\" does not exist");
  TriangleMesh mesh = load_obj(file, {.to_world = properties.transform("to_world"),
                                      .face_normals = properties.boolean("face_normals", false),
                                      .flip_tex_coords = properties.boolean("flip_tex_coords", true)});
  mesh.flip_normals = properties.boolean("flip_normals", false);
  return mesh;
}

constexpr ShapeEntry k_shapes[] = {
    {"rectangle", "the square [-1,1]^2 at z = 0, normal +z", make_rectangle},
    {"cube", "the surface of [-1,1]^3, normals outwards", make_cube},
    {"obj", "the polygons of a Wavefront OBJ file", make_obj},
};

}  // namespace

std::span<const ShapeEntry> shape_registry() { return k_shapes; }

}  // namespace gradslc
