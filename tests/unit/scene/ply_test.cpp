#include "scene/loaders/ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "core/error.h"

namespace gradslc {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TriangleMesh parse(std::string_view bytes, const MeshFileOptions& options = {}) {
  return parse_ply(bytes, "test.ply", options);
}

/// First line of the error.
std::string refusal(std::string_view bytes) {
  try {
    parse(bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    const std::string what = error.what();
    return what.substr(0, what.find('\n'));
  }
  return "accepted";
}

std::string header(std::string_view format, std::string_view vertex = "4", std::string_view face = "1") {
  return "ply\nformat " + std::string(format) + " 1.0\ncomment made by hand\nelement vertex " + std::string(vertex) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::string(face) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

constexpr std::string_view k_square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// Appends numbers in the byte order asked for.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  template <class Number>
  Bytes& add(Number value) {
    std::array<char, sizeof(Number)> raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    text_.append(raw.data(), raw.size());
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

std::string binary_square(bool big_endian) {
  Bytes bytes(big_endian);
  for (const float value : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) bytes.add(value);
  bytes.add(std::uint8_t{4});
  for (const std::int32_t index : {0, 1, 2, 3}) bytes.add(index);
  return header(big_endian ? "binary_big_endian" : "binary_little_endian") + bytes.text();
}

TEST(Ply, ReadsAllThreeFormatsAlike) {
  for (const std::string& file :
       {header("ascii") + std::string(k_square) + "4 0 1 2 3\n", binary_square(false), binary_square(true)}) {
    const TriangleMesh mesh = parse(file);
    EXPECT_EQ(mesh.positions, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(mesh.uvs.empty());
    ASSERT_EQ(mesh.normals.size(), 4u);  // computed
    EXPECT_EQ(mesh.normals[0], (Normal3{0, 0, 1}));
  }
}

TEST(Ply, ReadsNormalsAndUvsUnderAllTheirNamesAndSkipsTheRest) {
  for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const std::string file = std::string("ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty uchar red\r\n") +
                             "property double z\r\nproperty double y\r\nproperty double x\r\nproperty float nx\r\n"
                             "property float ny\r\nproperty float nz\r\nproperty float " +
                             v + "\r\nproperty float " + u +
                             "\r\nelement edge 1\r\nproperty int a\r\nproperty list uchar float b\r\n"
                             "element face 1\r\nproperty int flags\r\nproperty list uint8 uint32 vertex_index\r\n"
                             "end_header\r\n255 0 0 0 0 0 2 0.25 0.5\r\n255 0 0 1 0 0 2 0 1\r\n255 0 1 0 0 0 2 1 1\r\n"
                             "7 2 1.5 2.5\r\n9 3 0 1 2\r\n";
    const TriangleMesh mesh = parse(file);
    EXPECT_EQ(mesh.positions[1], (Point3{1, 0, 0}));
    EXPECT_EQ(mesh.uvs[0], (Vec2{0.5f, 0.25f}));
    EXPECT_EQ(mesh.normals[0], (Normal3{0, 0, 1}));
    EXPECT_EQ(parse(file, {.flip_tex_coords = true}).uvs[0], (Vec2{0.5f, 0.75f}));
    EXPECT_TRUE(parse(file, {.face_normals = true}).normals.empty());
  }
}

TEST(Ply, NormalsChooseTheSideOfTriangles) {
  const std::string file =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n";
  EXPECT_EQ(parse(file).triangles, (Triangles{{0, 2, 1}}));
  EXPECT_EQ(parse(file, {.face_normals = true}).triangles, (Triangles{{0, 1, 2}}));
}

TEST(Ply, SaysWhereItsHeaderIsWrong) {
  EXPECT_EQ(refusal(""), "test.ply:1:1: error: the header has no line \"end_header\"");
  EXPECT_EQ(refusal("solid\n"), "test.ply:1:1: error: is not a PLY file: its first line must be \"ply\"");
  EXPECT_EQ(refusal("ply\nformat ascii 2.0\nend_header\n"), "test.ply:2:7: error: the format's version must be 1.0");
  EXPECT_EQ(refusal("ply\nelement vertex many\n"),
            "test.ply:2:16: error: the count of element \"vertex\" must be a whole number");
  EXPECT_EQ(refusal("ply\nelement vertex -1\n"),
            "test.ply:2:16: error: the count of element \"vertex\" must be a whole number");
  EXPECT_EQ(refusal("ply\nproperty float x\n"), "test.ply:2:1: error: a property must follow an element");
  EXPECT_EQ(refusal("ply\nelement vertex 1\nproperty real x\n").substr(0, 43),
            "test.ply:3:10: error: unknown type \"real\"; ");
  EXPECT_EQ(refusal("ply\nelement face 1\nproperty list float int vertex_indices\n"),
            "test.ply:3:10: error: the count of a list must be of a whole type");
  EXPECT_EQ(refusal("ply\nnonsense\n").substr(0, 46), "test.ply:2:1: error: unknown word \"nonsense\" i");
  EXPECT_EQ(refusal("ply\nend_header\n"), "test.ply:2:11: error: the header has no line \"format\"");
  EXPECT_EQ(refusal("ply\nformat ascii 1.0\nend_header\n"), "test.ply: error: has no element vertex");
  EXPECT_EQ(refusal("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nelement face 0\n"
                    "property list uchar int vertex_index\nend_header\n"),
            "test.ply: error: element vertex has no property z");
  EXPECT_EQ(refusal("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"),
            "test.ply: error: needs an element face with one list vertex_indices (or vertex_index)");
}

TEST(Ply, SaysWhereItsDataAreWrong) {
  const std::string text = header("ascii") + std::string(k_square);
  EXPECT_EQ(refusal(text + "4 0 1 2 4\n"), "test.ply:15:9: error: there is no vertex 4: there are 4, counted from 0");
  EXPECT_EQ(refusal(text + "3 0 1 -1\n"), "test.ply:15:7: error: there is no vertex -1: there are 4, counted from 0");
  EXPECT_EQ(refusal(text + "2 0 1\n"), "test.ply:15:1: error: a face needs at least three corners, not 2");
  EXPECT_EQ(refusal(text + "3 0 1 x\n"), "test.ply:15:7: error: a number is needed here");
  EXPECT_EQ(refusal(text + "3 0 1"), "test.ply:15:6: error: the file ends too early: a number is needed here");
  EXPECT_EQ(refusal(header("ascii") + "0 0 nan\n" + std::string(k_square)),
            "test.ply:11:5: error: a finite number is needed here, not nan");
  const std::string binary = binary_square(true);
  EXPECT_EQ(refusal(binary.substr(0, binary.size() - 1)),
            "test.ply: error: byte " + std::to_string(binary.size() - 4) + ": the file ends too early");
  std::string garbled = binary;
  garbled[garbled.size() - 1] = 9;
  EXPECT_EQ(refusal(garbled), "test.ply: error: byte " + std::to_string(binary.size() - 4) +
                                  ": there is no vertex 9: there are 4, counted from 0");
}

// A header that lies must not make the loader ask for gigabytes.
TEST(Ply, ALyingCountIsFoundBeforeMemoryIsAskedFor) {
  EXPECT_EQ(refusal(header("ascii", "4000000000") + std::string(k_square)),
            "test.ply:11:1: error: 4000000000 of element vertex are declared, but the rest of the file has room for 5 "
            "at most");
  const std::string lying = header("binary_little_endian", "4", "4000000000");
  EXPECT_EQ(refusal(lying + std::string(60, '\0')),
            "test.ply: error: byte " + std::to_string(lying.size() + 48) +
                ": 4000000000 of element face are declared, but the rest of the file has room for 13 at most");
  EXPECT_EQ(refusal(header("ascii", "5000000000")), "test.ply: error: has too many vertices for 32-bit indices");
}

}  // namespace
}  // namespace gradslc
