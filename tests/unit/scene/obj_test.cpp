#include "scene/loaders/obj.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr std::string_view k_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TriangleMesh parse(std::string_view text, const MeshFileOptions& options = {.flip_tex_coords = true}) {
  return parse_obj(text, "test.obj", options);
}

std::string refusal(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    const std::string what = error.what();
    return what.substr(0, what.find('\n'));
  }
  return "accepted";
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST(Obj, CutsPolygonsIntoFans) {
  const TriangleMesh mesh = parse(std::string(k_square) + "v 0 0.5 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(mesh.positions[2], (Point3{1, 1, 0}));
}

TEST(Obj, CountsNegativeIndicesBackwardsFromTheLatest) {
  const TriangleMesh mesh = parse(std::string(k_square) + "f -4 -3 -2\nv 9 9 9\nf -5 -4 -1\n");
  EXPECT_EQ(mesh.positions[mesh.triangles[1][0]], (Point3{0, 0, 0}));
  EXPECT_EQ(mesh.positions[mesh.triangles[1][2]], (Point3{9, 9, 9}));
}

TEST(Obj, SharesVerticesThatAgreeInAllIndices) {
  const std::string text = std::string(k_square) +
                           "vt 0 0\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\nf 1/2/1 2/1/1 3/1/1\n";
  const TriangleMesh mesh = parse(text);
  EXPECT_EQ(mesh.positions.size(), 5u);  // four corners, the first one with two uvs
  EXPECT_EQ(mesh.triangles[0][0], mesh.triangles[1][0]);
  EXPECT_NE(mesh.triangles[0][0], mesh.triangles[2][0]);
  EXPECT_EQ(mesh.uvs.size(), 5u);
  EXPECT_EQ(mesh.normals.size(), 5u);
}

TEST(Obj, FlipsTextureCoordinatesUnlessToldNotTo) {
  const std::string text = std::string(k_square) + "vt 0.25 0.125 7\nf 1/1 2/1 3/1\n";
  EXPECT_EQ(parse(text).uvs[0], (Vec2{0.25f, 0.875f}));
  EXPECT_EQ(parse(text, {.face_normals = false, .flip_tex_coords = false}).uvs[0], (Vec2{0.25f, 0.125f}));
}

TEST(Obj, LeavesMissingUvsAndNormalsEmptyOrZero) {
  EXPECT_TRUE(parse(std::string(k_square) + "vt 1 1\nf 1 2 3\n").uvs.empty());
  const TriangleMesh mixed = parse(std::string(k_square) + "vt 1 0\nvn 0 0 1\nf 1/1 2//1 3\n");
  EXPECT_EQ(mixed.uvs[0], (Vec2{1, 1}));
  EXPECT_EQ(mixed.uvs[1], (Vec2{0, 0}));
  EXPECT_EQ(mixed.normals[0], (Normal3{0, 0, 0}));
  EXPECT_EQ(mixed.normals[1], (Normal3{0, 0, 1}));
}

// A roof of two planes: its ridge gets the mean by angles, its eaves keep their plane's normal.
TEST(Obj, ComputesSmoothNormalsWhereTheFileHasNone) {
  constexpr std::string_view k_roof = "v -1 0 0\nv 0 1 0\nv 0 1 1\nv 1 0 0\nf 1 3 2\nf 2 3 4\n";
  const TriangleMesh mesh = parse(k_roof);
  ASSERT_EQ(mesh.normals.size(), 4u);
  EXPECT_NEAR(mesh.normals[0].x, -std::sqrt(0.5f), 1e-6f);
  for (const Normal3 n : mesh.normals) EXPECT_NEAR(length(as_vec(n)), 1, 1e-6f);
  EXPECT_NEAR(mesh.normals[1].y, 1, 1e-6f);  // the angles at the ridge are equal on both sides
  EXPECT_TRUE(parse(k_roof, {.face_normals = true, .flip_tex_coords = true}).normals.empty());
}

TEST(Obj, NormalsChooseTheSideOfTriangles) {
  const std::string text = std::string(k_square) + "vn 0 0 -1\nf 1//1 2//1 3//1\n";
  EXPECT_EQ(parse(text).triangles, (Triangles{{0, 2, 1}}));
  // A mirroring map turns the winding round and keeps the normals: the winding follows.
  const TriangleMesh mirrored =
      parse(std::string(k_square) + "vn 0 0 1\nf 1//1 2//1 3//1\n",
            {.to_world = Transform::scaling(-1, 1, 1), .face_normals = false, .flip_tex_coords = true});
  EXPECT_EQ(mirrored.normals[0], (Normal3{0, 0, 1}));
  EXPECT_EQ(mirrored.triangles, (Triangles{{0, 2, 1}}));
}

TEST(Obj, TransformsNormalsByTheInverseTranspose) {
  const TriangleMesh mesh =
      parse("v 0 0 0\nv 1 -1 0\nv 0 0 1\nvn 1 1 0\nf 1//1 2//1 3//1\n",
            {.to_world = Transform::scaling(2, 1, 1), .face_normals = false, .flip_tex_coords = true});
  const Vec3 expected = normalize(Vec3{0.5f, 1, 0});
  EXPECT_NEAR(mesh.normals[0].x, expected.x, 1e-6f);
  EXPECT_NEAR(mesh.normals[0].y, expected.y, 1e-6f);
  EXPECT_EQ(mesh.positions[1], (Point3{2, -1, 0}));
}

TEST(Obj, ReadsWhatFilesInTheWildContain) {
  const TriangleMesh mesh = parse(
      "# exported\r\nmtllib a.mtl\r\no thing\r\ng part one\r\n\r\n  v\t+0 0 0 1.0\r\nv 1e0 -0. 0 0.5 0.5 0.5\r\nv 1 1 "
      "\\\r\n 0\r\n"
      "usemtl red\r\ns off\r\nf 1 2 3 # last\r\nl 1 2\r\nf 1 2 3");
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_TRUE(parse("").triangles.empty());
}

TEST(Obj, SaysWhereAndWhatIsWrong) {
  const std::string square(k_square);
  EXPECT_EQ(refusal(square + "f 1 2 5\n"), "test.obj:5:7: error: there is no vertex 5: 4 were given before this line");
  EXPECT_EQ(refusal(square + "f 1 2 0\n"), "test.obj:5:7: error: there is no vertex 0: 4 were given before this line");
  EXPECT_EQ(refusal(square + "f 1 2 -5\n"),
            "test.obj:5:7: error: there is no vertex -5: 4 were given before this line");
  EXPECT_EQ(refusal(square + "f 1/1 2 3\n"), "test.obj:5:5: error: there is no uv 1: 0 were given before this line");
  EXPECT_EQ(refusal(square + "f 1//2 2 3\n"),
            "test.obj:5:6: error: there is no normal 2: 0 were given before this line");
  EXPECT_EQ(refusal(square + "f 1 2\n"), "test.obj:5:6: error: a face needs at least three corners, not 2");
  EXPECT_EQ(refusal(square + "f 1 2 x\n").substr(0, 47), "test.obj:5:7: error: a corner is needed here: v");
  EXPECT_EQ(refusal(square + "f 1 2 99999999999999999999\n").substr(0, 43),
            "test.obj:5:7: error: a corner is needed her");
  EXPECT_EQ(refusal(square + "f 1 2 3z\n").substr(0, 43), "test.obj:5:8: error: a corner is needed her");
  EXPECT_EQ(refusal("v 1 2\n"), "test.obj:1:6: error: a finite number is needed here");
  EXPECT_EQ(refusal("v 1 2 inf\n"), "test.obj:1:7: error: a finite number is needed here");
  EXPECT_EQ(refusal("v 1 2 3e99\n"), "test.obj:1:7: error: a finite number is needed here");
  EXPECT_EQ(refusal("\nvertex 1 2 3\n"),
            "test.obj:2:1: error: unknown statement \"vertex\"; polygons are given by v, vt, vn and f");
}

}  // namespace
}  // namespace gradslc
