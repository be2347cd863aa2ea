#include "scene/mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "scene/triangle.h"

namespace gradslc {
namespace {

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void fail(const TriangleMesh& mesh, const std::string& message) {
  throw_input_error("", fmt::format("mesh \"{}\": {}", mesh.name, message));
}

}  // namespace

Bounds3 TriangleMesh::bounds() const {
  Bounds3 bounds;
  for (const auto& triangle : triangles)
    for (const std::uint32_t vertex : triangle) bounds.extend(positions[vertex]);
  return bounds;
}

void check_mesh(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices)
    fail(mesh,
         fmt::format("has {} normals for {} vertices, needs one per vertex or none", mesh.normals.size(), vertices));
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices)
    fail(mesh, fmt::format("has {} uvs for {} vertices, needs one per vertex or none", mesh.uvs.size(), vertices));
  for (std::size_t i = 0; i < vertices; ++i)
    if (!is_finite(from_origin(mesh.positions[i]))) fail(mesh, fmt::format("position {} is not finite", i));
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (!is_finite(as_vec(mesh.normals[i]))) fail(mesh, fmt::format("normal {} is not finite", i));
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
    if (!std::isfinite(mesh.uvs[i].x) || !std::isfinite(mesh.uvs[i].y))
      fail(mesh, fmt::format("uv {} is not finite", i));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= vertices)
        fail(mesh, fmt::format("triangle {} asks for vertex {}, there are {}", i, vertex, vertices));
}

void remove_empty_triangles(TriangleMesh& mesh) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return triangle_shape(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).double_area == 0;
  });
}

}  // namespace gradslc
