#include "scene/loaders/serialized.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "core/error.h"
#include "serialized_fixture.h"

namespace gradslc {
namespace {

using test::SerializedMesh;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TriangleMesh parse(const std::string& bytes, int shape_index = 0, const MeshFileOptions& options = {}) {
  std::istringstream stream(bytes);
  return parse_serialized(stream, "test.serialized", shape_index, options);
}

std::string refusal(const std::string& bytes, int shape_index = 0) {
  try {
    parse(bytes, shape_index);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "accepted";
}

constexpr std::uint32_t k_normals = 0x1, k_uvs = 0x2, k_colours = 0x8, k_face_normals = 0x10, k_single = 0x1000,
                        k_double = 0x2000;

SerializedMesh full_mesh(std::uint32_t precision) {
  return {.flags = precision | k_normals | k_uvs | k_colours,
          .numbers = {0,  0,   0,    1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, -1, 0, 0,
                      -1, 0.5, 0.25, 1, 0, 0, 1, 9, 9, 9, 9, 9,  9, 9, 9,  9}};
}

TEST(Serialized, ReadsBothVersionsAndPrecisions) {
  for (const std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}})
    for (const std::uint32_t precision : {k_single, k_double}) {
      const std::string file = test::serialized_file({full_mesh(precision)}, version);
      const TriangleMesh mesh = parse(file);
      EXPECT_EQ(mesh.positions, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
      EXPECT_EQ(mesh.normals[0], (Normal3{0, 0, -1}));
      EXPECT_EQ(mesh.uvs[0], (Vec2{0.5f, 0.25f}));
      EXPECT_EQ(mesh.triangles, (Triangles{{0, 2, 1}}));  // the normals choose the side
      EXPECT_TRUE(parse(file, 0, {.face_normals = true}).normals.empty());
    }
}

TEST(Serialized, ComputesNormalsUnlessTheFileSaysFaceNormals) {
  EXPECT_EQ(parse(test::serialized_file({{}}, 4)).normals[0], (Normal3{0, 0, 1}));
  EXPECT_TRUE(parse(test::serialized_file({{.flags = k_single | k_face_normals}}, 4)).normals.empty());
}

TEST(Serialized, FindsMeshesByTheDictionary) {
  const SerializedMesh second{.numbers = {5, 0, 0, 6, 0, 0, 5, 1, 0}}, third{.numbers = {7, 0, 0, 8, 0, 0, 7, 1, 0}};
  for (const std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}}) {
    const std::string file = test::serialized_file({{}, second, third}, version);
    EXPECT_EQ(parse(file, 0).positions[0].x, 0);
    EXPECT_EQ(parse(file, 1).positions[0].x, 5);
    EXPECT_EQ(parse(file, 2).positions[0].x, 7);
    EXPECT_EQ(refusal(file, 3), "test.serialized: error: has no mesh 3: there are 3, counted from 0");
  }
}

TEST(Serialized, SaysWhereAFileIsWrong) {
  const std::string good = test::serialized_file({{}}, 4);
  EXPECT_EQ(refusal(""), "test.serialized: error: byte 0: the file ends too early");
  EXPECT_EQ(refusal("PK\3\4 and so on"),
            "test.serialized: error: byte 0: no serialized mesh begins here: it would begin with 1c 04");
  std::string version = good;
  version[2] = 5;
  EXPECT_EQ(refusal(version), "test.serialized: error: byte 2: version 5 is not supported, only 3 and 4 are");
  std::string dictionary = good;
  dictionary[dictionary.size() - 5] = 1;  // the highest byte of the offset
  EXPECT_EQ(refusal(dictionary), fmt::format("test.serialized: error: byte {}: mesh 0 cannot stand from byte {} to {}",
                                             good.size() - 12, 1ull << 56, good.size() - 12));
  std::string count = good;
  count[count.size() - 1] = 9;
  EXPECT_EQ(refusal(count), fmt::format("test.serialized: error: byte {}: the dictionary cannot have {} meshes",
                                        good.size() - 4, (9u << 24) + 1));
  std::string damaged = good;
  damaged[6] = static_cast<char>(damaged[6] ^ 0x7f);
  EXPECT_NE(refusal(damaged).find("the compressed data are damaged"), std::string::npos);
  EXPECT_NE(refusal(test::serialized_file({{.flags = 0}}, 4)).find("either single or double precision"),
            std::string::npos);
  EXPECT_NE(refusal(test::serialized_file({{.indices = {0, 1, 3}}}, 4)).find("there is no vertex 3: there are 3"),
            std::string::npos);
  EXPECT_NE(refusal(test::serialized_file({{.indices = {0, 1}}}, 4)).find("hold less than their header says"),
            std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(test::serialized_file({{.numbers = {0, 0, 0, 1, 0, nan, 0, 1, 0}}}, 4)).find("not a finite number"),
            std::string::npos);
}

TEST(Serialized, TruncatedFilesAreRefused) {
  const std::string good = test::serialized_file({full_mesh(k_double)}, 4);
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_NE(refusal(good.substr(0, size)), "accepted") << size;
}

TEST(Serialized, ALyingCountIsFoundBeforeMemoryIsAskedFor) {
  for (const SerializedMesh& mesh : {SerializedMesh{.vertices = 4'000'000'000}, {.triangles = 1ull << 60}})
    EXPECT_NE(refusal(test::serialized_file({mesh}, 4)).find("more than the compressed data can hold"),
              std::string::npos);
}

}  // namespace
}  // namespace gradslc
