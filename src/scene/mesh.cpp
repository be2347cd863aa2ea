#include "scene/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void fail(const TriangleMesh& mesh, const std::string& message) {
  throw_input_error("", fmt::format("mesh \"{}\": {}", mesh.name, message));
}

void check_sizes(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices)
    fail(mesh,
         fmt::format("has {} normals for {} vertices, needs one per vertex or none", mesh.normals.size(), vertices));
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices)
    fail(mesh, fmt::format("has {} uvs for {} vertices, needs one per vertex or none", mesh.uvs.size(), vertices));
}

/// Of the vertices and triangles from `begin` to `end`, as far as there are any.
void check_values(const TriangleMesh& mesh, std::size_t begin, std::size_t end) {
  const std::size_t vertices = mesh.positions.size();
  for (std::size_t i = begin; i < std::min(end, vertices); ++i)
    if (!is_finite(from_origin(mesh.positions[i]))) fail(mesh, fmt::format("position {} is not finite", i));
  for (std::size_t i = begin; i < std::min(end, mesh.normals.size()); ++i)
    if (!is_finite(as_vec(mesh.normals[i]))) fail(mesh, fmt::format("normal {} is not finite", i));
  for (std::size_t i = begin; i < std::min(end, mesh.uvs.size()); ++i)
    if (!std::isfinite(mesh.uvs[i].x) || !std::isfinite(mesh.uvs[i].y))
      fail(mesh, fmt::format("uv {} is not finite", i));
  for (std::size_t i = begin; i < std::min(end, mesh.triangles.size()); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= vertices)
        fail(mesh, fmt::format("triangle {} asks for vertex {}, there are {}", i, vertex, vertices));
}

constexpr std::size_t k_block = 16384;  // vertices and triangles that one thread takes at a time

/// A piece of a mesh.
struct Block {
  std::size_t mesh, begin, end;
  Bounds3 bounds;  // of the triangles with area
};

std::vector<Block> cut_into_blocks(const std::vector<TriangleMesh>& meshes) {
  std::vector<Block> blocks;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const std::size_t size = std::max(meshes[m].positions.size(), meshes[m].triangles.size());
    for (std::size_t begin = 0; begin < size; begin += k_block)
      blocks.push_back({m, begin, std::min(begin + k_block, size), {}});
  }
  return blocks;
}

void make_room(const TriangleMesh& mesh, PreparedMesh& prepared) {
  prepared.material = mesh.material;
  prepared.has_normals = !mesh.normals.empty();
  prepared.has_uvs = !mesh.uvs.empty();
  prepared.triangles.resize(mesh.triangles.size());
}

void prepare_triangles(const TriangleMesh& mesh, PreparedMesh& prepared, Block& block) {
  for (std::size_t i = block.begin; i < std::min(block.end, mesh.triangles.size()); ++i) {
    const auto& t = mesh.triangles[i];
    PreparedTriangle& triangle = prepared.triangles[i];
    triangle.a = mesh.positions[t[0]], triangle.b = mesh.positions[t[1]], triangle.c = mesh.positions[t[2]];
    triangle.shape = triangle_shape(triangle.a, triangle.b, triangle.c);
    if (mesh.flip_normals) triangle.shape.normal = -triangle.shape.normal;
    if (!triangle.shape.has_area()) continue;
    for (const std::uint32_t vertex : t) block.bounds.extend(mesh.positions[vertex]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (prepared.has_normals) triangle.normals[k] = mesh.normals[t[k]];
      if (prepared.has_uvs) triangle.uvs[k] = mesh.uvs[t[k]];
    }
  }
}

void remove_empty_triangles(TriangleMesh& mesh, PreparedMesh& prepared) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!prepared.triangles[i].shape.has_area()) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    prepared.triangles[kept] = prepared.triangles[i];
    ++kept;
  }
  mesh.triangles.resize(kept);
  prepared.triangles.resize(kept);
}

}  // namespace

Bounds3 TriangleMesh::bounds() const {
  Bounds3 bounds;
  for (const auto& triangle : triangles)
    for (const std::uint32_t vertex : triangle) bounds.extend(positions[vertex]);
  return bounds;
}

void check_mesh(const TriangleMesh& mesh) {
  check_sizes(mesh);
  check_values(mesh, 0, std::max(mesh.positions.size(), mesh.triangles.size()));
}

PreparedMeshes prepare_meshes(std::vector<TriangleMesh>& meshes) {
  for (const TriangleMesh& mesh : meshes) check_sizes(mesh);
  PreparedMeshes prepared;
  prepared.meshes.resize(meshes.size());
  parallel_for(meshes.size(), 1, [&](std::size_t m, std::size_t) { make_room(meshes[m], prepared.meshes[m]); });
  std::vector<Block> blocks = cut_into_blocks(meshes);
  parallel_for(blocks.size(), 1, [&](std::size_t i, std::size_t) {
    Block& block = blocks[i];
    check_values(meshes[block.mesh], block.begin, block.end);
    prepare_triangles(meshes[block.mesh], prepared.meshes[block.mesh], block);
  });
  for (const Block& block : blocks) prepared.bounds.extend(block.bounds);
  parallel_for(meshes.size(), 1,
               [&](std::size_t m, std::size_t) { remove_empty_triangles(meshes[m], prepared.meshes[m]); });
  return prepared;
}

}  // namespace gradslc
