#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/bounds.h"
#include "core/vec.h"
#include "scene/triangle.h"

namespace gradslc {

/// A triangle mesh in world space.
struct TriangleMesh {
  std::string name;
  std::vector<Point3> positions;
  std::vector<Normal3> normals;  ///< per vertex, unit, on the shading side; empty: flat
  std::vector<Vec2> uvs;         ///< per vertex; empty: barycentric coordinates serve
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool flip_normals = false;  ///< the geometric normal is the opposite of the winding's
  std::uint32_t material = 0;
  std::int32_t area_light = -1;  ///< index into SceneDescription::area_lights, or -1

  /// Of the vertices that triangles use.
  Bounds3 bounds() const;
};

/// Throws Error (input) that names the mesh where an index is out of range, a value is not finite, or the number of
/// normals or uvs differs from that of the positions.
void check_mesh(const TriangleMesh& mesh);

/// A triangle as hits need it, in two adjacent cache lines, without a detour through vertex indices: in large scenes
/// what a hit costs is the memory that it must wait for.
struct alignas(128) PreparedTriangle : Triangle {
  std::array<Normal3, 3> normals;  ///< of the corners a, b, c, where the mesh has normals
  std::array<Vec2, 3> uvs;         ///< alike
};

struct PreparedMesh {
  std::vector<PreparedTriangle> triangles;  ///< normals on the mesh's side (flip_normals)
  bool has_normals = false, has_uvs = false;
  std::uint32_t material = 0;
};

/// What is made of a scene's meshes once.
struct PreparedMeshes {
  std::vector<PreparedMesh> meshes;
  Bounds3 bounds;
};
/// Checks the meshes as check_mesh() does, drops the triangles without area, which nothing can hit, and prepares the
/// others; on all threads, within large meshes too. The Error is that of the first mesh that has one.
PreparedMeshes prepare_meshes(std::vector<TriangleMesh>& meshes);

}  // namespace gradslc
