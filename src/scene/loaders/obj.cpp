#include "scene/loaders/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "scene/triangle.h"

namespace gradslc {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t k_max_excerpt = 160;  // characters; longer lines are not shown

/// Statements that say nothing of polygons.
constexpr std::string_view k_ignored[] = {"o", "g", "s",   "mg",    "usemtl",   "mtllib",   "usemap",     "maplib",
                                          "l", "p", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};

/// Reads words and numbers, never beyond the end of a line; a backslash at its end joins the next one to it.
class Cursor {
 public:
  Cursor(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  bool at_end() const { return position_ == text_.size(); }
  bool at_line_end() {
    skip_blanks();
    return at_end() || text_[position_] == '\n' || text_[position_] == '#';
  }
  void next_line() {
    position_ = std::min(text_.find('\n', position_), text_.size());
    if (!at_end()) ++position_, ++line_;
  }
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = position_;
    while (!at_end() && !is_blank(text_[position_]) && text_[position_] != '\n') ++position_;
    return text_.substr(begin, position_ - begin);
  }
  float number() {
    skip_blanks();
    const Cursor begin = *this;
    float value = 0;
    if (!read(value) || !std::isfinite(value)) begin.fail("a finite number is needed here");
    return value;
  }
  bool try_integer(long long& value) { return read(value); }
  bool accept(char c) {
    if (at_end() || text_[position_] != c) return false;
    ++position_;
    return true;
  }
  [[noreturn]] void fail(std::string message) const {
    const std::size_t begin = position_ == 0 ? 0 : text_.rfind('\n', position_ - 1) + 1;  // npos + 1 = 0
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    SourcePosition where{
        .file = file_, .line = line_, .column = static_cast<int>(position_ - begin) + 1, .pointer = {}, .excerpt = {}};
    if (end - begin <= k_max_excerpt) where.excerpt = std::string(text_.substr(begin, end - begin));
    std::replace(where.excerpt.begin(), where.excerpt.end(), '\t', ' ');
    if (where.excerpt.ends_with('\r')) where.excerpt.pop_back();
    throw_input_error(std::move(where), std::move(message));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  void skip_blanks() {
    while (!at_end()) {
      if (is_blank(text_[position_])) {
        ++position_;
      } else if (text_.substr(position_, 2) == "\\\n" || text_.substr(position_, 3) == "\\\r\n") {
        next_line();
      } else {
        return;
      }
    }
  }
  template <class Number>
  bool read(Number& value) {
    const char* begin = text_.data() + position_;
    const char* const end = text_.data() + text_.size();
    if (begin != end && *begin == '+') ++begin;
    const auto [last, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc()) return false;
    position_ = static_cast<std::size_t>(last - text_.data());
    return true;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t position_ = 0;
  int line_ = 1;
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& file, const ObjOptions& options)
      : cursor_(text, file), options_(options) {}

  TriangleMesh parse() {
    for (; !cursor_.at_end(); cursor_.next_line())
      if (!cursor_.at_line_end()) statement();
    if (!any_uv_) mesh_.uvs.clear();
    if (!any_normal_ || options_.face_normals) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  /// Indices from 0 of a corner's position, uv and normal; k_none where the file gives none.
  struct Corner {
    std::uint32_t position = k_none, uv = k_none, normal = k_none;
    bool operator==(const Corner&) const = default;
  };

  void statement();
  void face();
  Corner corner();
  std::uint32_t index(std::size_t count, std::string_view what);
  std::uint32_t vertex(const Corner& corner);

  Cursor cursor_;
  const ObjOptions& options_;
  std::vector<Point3> positions_;
  std::vector<Vec2> uvs_;
  std::vector<Normal3> normals_;
  TriangleMesh mesh_;
  bool any_uv_ = false, any_normal_ = false;
  // Vertices of the mesh that share a position form a list: first_vertex_ by position, then next_vertex_ by vertex.
  std::vector<std::uint32_t> first_vertex_, next_vertex_;
  std::vector<Corner> corners_;  // of each vertex of the mesh
};

void ObjParser::statement() {
  const Cursor begin = cursor_;
  const std::string_view keyword = cursor_.word();
  if (keyword == "v") {
    const float x = cursor_.number(), y = cursor_.number(), z = cursor_.number();
    positions_.push_back(options_.to_world.apply(Point3{x, y, z}));
    first_vertex_.push_back(k_none);
  } else if (keyword == "vt") {
    const float u = cursor_.number(), v = cursor_.at_line_end() ? 0 : cursor_.number();
    uvs_.push_back({u, options_.flip_tex_coords ? 1 - v : v});
  } else if (keyword == "vn") {
    const float x = cursor_.number(), y = cursor_.number(), z = cursor_.number();
    normals_.push_back(options_.to_world.apply(Normal3{x, y, z}));
  } else if (keyword == "f") {
    face();
  } else if (std::find(std::begin(k_ignored), std::end(k_ignored), keyword) == std::end(k_ignored)) {
    begin.fail(fmt::format("unknown statement \"{:.20}\"; polygons are given by v, vt, vn and f", keyword));
  }
}

void ObjParser::face() {
  std::uint32_t first = 0, previous = 0;
  int count = 0;
  for (; !cursor_.at_line_end(); ++count) {
    const std::uint32_t current = vertex(corner());
    if (count == 0) first = current;
    if (count >= 2) mesh_.triangles.push_back({first, previous, current});
    previous = current;
  }
  if (count < 3) cursor_.fail(fmt::format("a face needs at least three corners, not {}", count));
}

/// "1", "1/2", "1//3" or "1/2/3".
ObjParser::Corner ObjParser::corner() {
  Corner corner;
  corner.position = index(positions_.size(), "vertex");
  if (corner.position == k_none)
    cursor_.fail("a corner is needed here: vertex, vertex/uv, vertex//normal or vertex/uv/normal");
  if (cursor_.accept('/')) {
    corner.uv = index(uvs_.size(), "uv");
    if (cursor_.accept('/')) corner.normal = index(normals_.size(), "normal");
  }
  any_uv_ |= corner.uv != k_none;
  any_normal_ |= corner.normal != k_none;
  if (options_.face_normals) corner.normal = k_none;
  return corner;
}

/// Index from 0 of a number that counts from 1, or backwards from the latest where it is negative; k_none: no number.
std::uint32_t ObjParser::index(std::size_t count, std::string_view what) {
  const Cursor begin = cursor_;
  long long number = 0;
  if (!cursor_.try_integer(number)) return k_none;
  const auto available = static_cast<long long>(count);
  if (number == 0 || number > available || number < -available)
    begin.fail(fmt::format("there is no {} {}: {} were given before this line", what, number, count));
  return static_cast<std::uint32_t>(number > 0 ? number - 1 : available + number);
}

std::uint32_t ObjParser::vertex(const Corner& corner) {
  std::uint32_t& first = first_vertex_[corner.position];
  for (std::uint32_t candidate = first; candidate != k_none; candidate = next_vertex_[candidate])
    if (corners_[candidate] == corner) return candidate;
  const auto added = static_cast<std::uint32_t>(corners_.size());
  if (added == k_none) cursor_.fail("the mesh has too many vertices for 32-bit indices");
  corners_.push_back(corner);
  next_vertex_.push_back(std::exchange(first, added));
  mesh_.positions.push_back(positions_[corner.position]);
  mesh_.uvs.push_back(corner.uv == k_none ? Vec2() : uvs_[corner.uv]);
  mesh_.normals.push_back(corner.normal == k_none ? Normal3{0, 0, 0} : normals_[corner.normal]);
  return added;
}

/// Between edges that are not zero.
float angle_between(Vec3 a, Vec3 b) {
  a = normalize(a), b = normalize(b);
  return std::atan2(length(cross(a, b)), dot(a, b));
}

TriangleShape shape_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  return triangle_shape(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
}

/// Mean of the adjoining triangles' normals by their angles at the vertex (Thuermer and Wuethrich 1998, "Computing
/// Vertex Normals from Polygonal Facets"); zero where they cancel.
void compute_normals(TriangleMesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const TriangleShape shape = shape_of(mesh, triangle);
    if (shape.double_area == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 corner = mesh.positions[triangle[i]];
      const float angle =
          angle_between(mesh.positions[triangle[(i + 1) % 3]] - corner, mesh.positions[triangle[(i + 2) % 3]] - corner);
      sums[triangle[i]] = sums[triangle[i]] + angle * as_vec(shape.normal);
    }
  }
  mesh.normals.clear();
  for (const Vec3 sum : sums) mesh.normals.push_back(as_normal(length_squared(sum) > 0 ? normalize(sum) : Vec3()));
}

void wind_by_normals(TriangleMesh& mesh) {
  for (auto& triangle : mesh.triangles) {
    const auto& [i, j, k] = triangle;
    const Vec3 sum = as_vec(mesh.normals[i]) + as_vec(mesh.normals[j]) + as_vec(mesh.normals[k]);
    const TriangleShape shape = shape_of(mesh, triangle);
    if (shape.double_area > 0 && dot(shape.normal, sum) < 0) std::swap(triangle[1], triangle[2]);
  }
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& file, const ObjOptions& options) {
  TriangleMesh mesh = ObjParser(text, file, options).parse();
  if (mesh.normals.empty() && !options.face_normals) {
    compute_normals(mesh);
  } else if (!mesh.normals.empty()) {
    wind_by_normals(mesh);
  }
  return mesh;
}

TriangleMesh load_obj(const std::filesystem::path& file, const ObjOptions& options) {
  return parse_obj(read_file(file), file.string(), options);
}

}  // namespace gradslc
