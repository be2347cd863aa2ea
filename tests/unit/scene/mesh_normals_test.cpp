#include "scene/loaders/mesh_normals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gradslc {
namespace {

/// Two squares that meet in the edge from (0,0,0) to (0,1,0); the second one rises by `degrees`. Four shared vertices
/// and two more.
TriangleMesh roof(double degrees) {
  const auto c = static_cast<float>(std::cos(degrees * k_pi / 180)),
             s = static_cast<float>(std::sin(degrees * k_pi / 180));
  TriangleMesh mesh;
  mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, s}, {c, 1, s}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  return mesh;
}

TEST(CreasedNormals, KeepEdgesThatAreSharperThanTheLimit) {
  TriangleMesh sharp = roof(40);
  compute_creased_normals(sharp, 30);
  EXPECT_EQ(sharp.positions.size(), 8u);  // the edge's vertices are split
  for (const std::size_t triangle : {0u, 1u})
    for (const std::uint32_t vertex : sharp.triangles[triangle]) EXPECT_NEAR(sharp.normals[vertex].z, 1, 1e-6f);
  for (const std::size_t triangle : {2u, 3u})
    for (const std::uint32_t vertex : sharp.triangles[triangle])
      EXPECT_NEAR(sharp.normals[vertex].z, std::cos(40 * k_pi / 180), 1e-6f);
}

TEST(CreasedNormals, SmoothEdgesThatAreNot) {
  TriangleMesh smooth = roof(20);
  compute_creased_normals(smooth, 30);
  EXPECT_EQ(smooth.positions.size(), 6u);
  EXPECT_NEAR(smooth.normals[smooth.triangles[0][1]].z, std::cos(10 * k_pi / 180), 1e-3f);
}

TEST(CreasedNormals, JoinVerticesThatAFileHasSplit) {
  TriangleMesh mesh = roof(20);
  TriangleMesh soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : triangle) soup.positions.push_back(mesh.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  compute_creased_normals(soup, 30);
  EXPECT_EQ(soup.positions.size(), 6u);
}

TEST(FinishNormals, DoesWhatTheOptionsSay) {
  const auto finish = [](const MeshFileOptions& options, bool has_normals) {
    TriangleMesh mesh = roof(40);
    if (has_normals) mesh.normals.assign(6, {0, 0, -1});
    finish_normals(mesh, options);
    return mesh;
  };
  EXPECT_TRUE(finish({.face_normals = true}, true).normals.empty());
  EXPECT_EQ(finish({.face_normals = true}, true).triangles, roof(40).triangles);
  EXPECT_EQ(finish({}, true).triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
  EXPECT_EQ(finish({}, false).normals.size(), 6u);
  EXPECT_EQ(finish({.max_smooth_angle = 30}, true).normals.size(), 8u);
}

TEST(ComputeNormals, PassOverTrianglesWithoutArea) {
  TriangleMesh mesh = roof(0);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 1, 4});  // three corners on a line
  compute_normals(mesh);
  for (const Normal3 n : mesh.normals) EXPECT_EQ(n, (Normal3{0, 0, 1}));
}

}  // namespace
}  // namespace gradslc
