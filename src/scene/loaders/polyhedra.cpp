#include "scene/loaders/polyhedra.h"

#include <array>

namespace gradslc {
namespace {

constexpr std::array<Vec2, 4> k_corner_uvs = {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};

/// Adds the four corners of a square face and its two triangles, (0,1,2) and (2,3,0).
void add_face(TriangleMesh& mesh, const std::array<Point3, 4>& corners, const std::array<Vec2, 4>& uvs) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first + 2, first + 3, first});
}

}  // namespace

TriangleMesh unit_rectangle() {
  TriangleMesh mesh;
  add_face(mesh, {Point3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, k_corner_uvs);
  return mesh;
}

/// u grows along `right` and v against `up`, with right x up the normal.
TriangleMesh unit_cube() {
  struct Face {
    Vec3 right, up;
  };
  constexpr Face k_faces[] = {{{0, 0, 1}, {-1, 0, 0}}, {{-1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}},
                              {{0, 1, 0}, {-1, 0, 0}}, {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {-1, 0, 0}}};
  TriangleMesh mesh;
  for (const auto& [right, up] : k_faces) {
    const Point3 centre = Point3() + cross(right, up);
    add_face(mesh, {centre - right - up, centre + right - up, centre + right + up, centre - right + up},
             {Vec2{0, 1}, Vec2{1, 1}, Vec2{1, 0}, Vec2{0, 0}});
  }
  return mesh;
}

}  // namespace gradslc
