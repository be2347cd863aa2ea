// Shapes that are read from files: their properties, the files that a scene names, errors.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/parallel.h"
#include "loader_fixtures.h"
#include "scene/scene.h"
#include "serialized_fixture.h"

namespace gradslc {
namespace {

constexpr std::string_view k_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
constexpr std::string_view k_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n"
    "property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n";

std::string scene(std::string_view shapes, std::string_view version = "3.0.0") {
  return fmt::format("<scene version=\"{}\">\n{}\n{}</scene>", version, shapes, test::k_sensor);
}
std::string shape(std::string_view type, std::string_view file, std::string_view more = {}) {
  return fmt::format("<shape type=\"{}\"><string name=\"filename\" value=\"{}\"/>{}</shape>\n", type, file, more);
}

TEST(MeshLoading, PropertiesOfBothDialects) {
  const test::TemporaryFolder folder;
  folder.write("a.obj", k_obj);
  folder.write("a.ply", k_ply);
  folder.write("a.serialized", test::serialized_file({{}, {.flags = 0x1000 | 0x10}}, 4));
  const auto load = [&](const std::string& shapes, const char* version) {
    return load_scene(folder.write("scene.xml", scene(shapes, version))).meshes.at(0);
  };
  const auto v = [](const TriangleMesh& mesh) { return mesh.uvs.at(0).y; };
  EXPECT_EQ(v(load(shape("obj", "a.obj"), "3.0.0")), 1);
  EXPECT_EQ(v(load(shape("obj", "a.obj", R"(<boolean name="flipTexCoords" value="false"/>)"), "0.6.0")), 0);
  EXPECT_EQ(v(load(shape("ply", "a.ply"), "3.0.0")), 0);
  EXPECT_EQ(v(load(shape("ply", "a.ply", R"(<boolean name="flip_tex_coords" value="true"/>)"), "3.0.0")), 1);
  EXPECT_TRUE(load(shape("ply", "a.ply", R"(<boolean name="faceNormals" value="true"/>)"), "0.6.0").normals.empty());
  EXPECT_TRUE(load(shape("ply", "a.ply", R"(<boolean name="flipNormals" value="true"/>)"), "0.6.0").flip_normals);
  EXPECT_EQ(load(shape("obj", "a.obj", R"(<float name="maxSmoothAngle" value="20"/>)"), "0.6.0").normals.size(), 3u);
  EXPECT_FALSE(load(shape("serialized", "a.serialized"), "3.0.0").normals.empty());
  EXPECT_TRUE(
      load(shape("serialized", "a.serialized", R"(<integer name="shapeIndex" value="1"/>)"), "0.6.0").normals.empty());
}

TEST(MeshLoading, TheSceneKnowsEveryFileOnce) {
  const test::TemporaryFolder folder;
  folder.write("a.obj", k_obj);
  folder.write("parts/b.ply", k_ply);
  folder.write("parts/more.xml", "<scene version=\"3.0.0\">" + shape("ply", "b.ply") + "</scene>");
  const std::string file = folder.write(
      "scene.xml", scene(shape("obj", "a.obj") + R"(<include filename="parts/more.xml"/>)" + shape("obj", "a.obj")));
  const std::filesystem::path root = std::filesystem::path(file).parent_path();
  const SceneDescription description = load_scene(file);
  EXPECT_EQ(description.files, (std::vector<std::filesystem::path>{file, root / "parts/more.xml", root / "a.obj",
                                                                   root / "parts" / "b.ply"}));
  EXPECT_EQ(description.meshes.size(), 3u);
}

// The order of loading is by size and the threads race; what is reported is not.
TEST(MeshLoading, TheFirstFaultyMeshInTheOrderOfTheFileIsReported) {
  const test::TemporaryFolder folder;
  folder.write("good.obj", k_obj);
  folder.write("small.obj", "v 1\n");
  folder.write("large.obj", std::string(100000, '\n') + "v 2\n");
  const std::string file = folder.write(
      "scene.xml", scene(shape("obj", "good.obj") + shape("obj", "small.obj") + shape("obj", "large.obj")));
  for (int threads = 1; threads <= 4; ++threads) {
    set_thread_count(threads);
    try {
      load_scene(file);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(std::filesystem::path(error.where().file).filename(), "small.obj");
    }
  }
  set_thread_count(0);
}

TEST(MeshLoading, MeshesKeepTheOrderOfTheFile) {
  const test::TemporaryFolder folder;
  folder.write("small.obj", k_obj);
  folder.write("large.obj", std::string(100000, '\n') + std::string(k_obj) + "v 5 5 5\nf 1 2 4\n");
  const SceneDescription description =
      load_scene(folder.write("scene.xml", scene(shape("obj", "small.obj") + shape("obj", "large.obj") +
                                                 shape("obj", "small.obj") + R"(<shape type="cube" id="box"/>)")));
  ASSERT_EQ(description.meshes.size(), 4u);
  EXPECT_EQ(description.meshes[0].name, "obj at line 2");
  EXPECT_EQ(description.meshes[1].triangles.size(), 2u);
  EXPECT_EQ(description.meshes[2].triangles.size(), 1u);
  EXPECT_EQ(description.meshes[3].name, "box");
}

TEST(PrepareMeshes, ReportsTheFirstFaultyMeshWhateverTheThreads) {
  std::vector<TriangleMesh> meshes(3);
  for (TriangleMesh& mesh : meshes) {
    mesh.positions.assign(100000, {0, 0, 0});
    mesh.triangles = {{0, 1, 2}};
  }
  meshes[1].name = "second";
  meshes[1].positions.back().x = k_infinity;
  meshes[2].name = "third";
  meshes[2].triangles[0][0] = 100000;
  for (int threads = 1; threads <= 4; ++threads) {
    set_thread_count(threads);
    try {
      prepare_meshes(meshes);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.message(), "mesh \"second\": position 99999 is not finite");
    }
  }
  set_thread_count(0);
}

TEST(PrepareMeshes, DropsTrianglesWithoutAreaAndKeepsTheOthersInOrder) {
  std::vector<TriangleMesh> meshes(1);
  TriangleMesh& mesh = meshes[0];
  mesh.flip_normals = true;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {5, 5, 5}};
  for (int i = 0; i < 20000; ++i) {
    mesh.triangles.push_back({0, 3, 3});
    mesh.triangles.push_back(i % 2 == 0 ? std::array<std::uint32_t, 3>{0, 1, 2}
                                        : std::array<std::uint32_t, 3>{2, 1, 0});
  }
  const PreparedMeshes prepared = prepare_meshes(meshes);
  ASSERT_EQ(mesh.triangles.size(), 20000u);
  const std::vector<PreparedTriangle>& triangles = prepared.meshes[0].triangles;
  ASSERT_EQ(triangles.size(), 20000u);
  for (std::size_t i = 0; i < 20000; ++i) {
    ASSERT_EQ(mesh.triangles[i][0], i % 2 == 0 ? 0u : 2u);
    ASSERT_EQ(triangles[i].shape.normal.z, i % 2 == 0 ? -1 : 1);
    ASSERT_EQ(triangles[i].a, (i % 2 == 0 ? Point3{0, 0, 0} : Point3{0, 2, 0}));
    ASSERT_TRUE(triangles[i].shape.has_area());
  }
  EXPECT_EQ(prepared.bounds.upper, (Point3{1, 2, 0}));
}

}  // namespace
}  // namespace gradslc
