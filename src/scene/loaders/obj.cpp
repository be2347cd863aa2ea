#include "scene/loaders/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "scene/loaders/mesh_normals.h"

namespace gradslc {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

/// Statements that say nothing of polygons.
constexpr std::string_view k_ignored[] = {"o", "g", "s",   "mg",    "usemtl",   "mtllib",   "usemap",     "maplib",
                                          "l", "p", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};

/// Reads words and numbers, never beyond the end of a line; a backslash at its end joins the next one to it.
class Cursor {
 public:
  Cursor(std::string_view text, const std::string& file)
      : begin_(text.data()), next_(begin_), end_(begin_ + text.size()), file_(&file) {}

  bool at_end() const { return next_ == end_; }
  bool at_line_end() {
    skip_blanks();
    return at_end() || *next_ == '\n' || *next_ == '#';
  }
  void next_line() {
    next_ = std::find(next_, end_, '\n');
    if (!at_end()) ++next_;
  }
  std::string_view word() {
    skip_blanks();
    const char* const begin = next_;
    while (!at_end() && !is_blank(*next_) && *next_ != '\n') ++next_;
    return {begin, static_cast<std::size_t>(next_ - begin)};
  }
  float number() {
    skip_blanks();
    const char* const begin = next_;
    float value = 0;
    if (!read(value) || !std::isfinite(value)) fail("a finite number is needed here", begin);
    return value;
  }
  bool try_integer(long long& value) { return read(value); }
  bool accept(char c) {
    if (at_end() || *next_ != c) return false;
    ++next_;
    return true;
  }
  const char* position() const { return next_; }
  [[noreturn]] void fail(std::string message) const { fail(std::move(message), next_); }
  [[noreturn]] void fail(std::string message, const char* position) const {
    throw_input_error(position_in_text({begin_, static_cast<std::size_t>(end_ - begin_)}, *file_,
                                       static_cast<std::size_t>(position - begin_)),
                      std::move(message));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  void skip_blanks() {
    while (!at_end()) {
      if (is_blank(*next_)) {
        ++next_;
      } else if (*next_ == '\\' && joins_lines()) {
        next_line();
      } else {
        return;
      }
    }
  }
  bool joins_lines() const {
    const std::string_view rest(next_, static_cast<std::size_t>(end_ - next_));
    return rest.starts_with("\\\n") || rest.starts_with("\\\r\n");
  }
  template <class Number>
  bool read(Number& value) {
    const char* begin = next_;
    if (begin != end_ && *begin == '+') ++begin;
    const auto [last, failure] = std::from_chars(begin, end_, value);
    if (failure != std::errc()) return false;
    next_ = last;
    return true;
  }

  const char *begin_, *next_, *end_;
  const std::string* file_;
};

/// Indices from 0 of a corner's position, uv and normal; k_none where the file gives none.
struct Corner {
  std::uint32_t position = k_none, uv = k_none, normal = k_none;
  bool operator==(const Corner&) const = default;
};

/// Numbers corners that differ in the order in which they come: a hash table with open addressing.
class CornerTable {
 public:
  /// The corner's number; that of a new one is the count before.
  std::uint32_t number(const Corner& corner) {
    if (2 * (corners_.size() + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[find_slot(corner)];
    if (slot == k_none) {
      slot = static_cast<std::uint32_t>(corners_.size());
      corners_.push_back(corner);
    }
    return slot;
  }
  const std::vector<Corner>& corners() const { return corners_; }

 private:
  std::size_t find_slot(const Corner& corner) const {
    const std::uint64_t position_uv = (std::uint64_t{corner.position} << 32) | corner.uv;
    std::size_t slot = hash_combine(position_uv, corner.normal) & (slots_.size() - 1);
    while (slots_[slot] != k_none && corners_[slots_[slot]] != corner) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }
  void grow() {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), k_none);
    for (std::uint32_t i = 0; i < corners_.size(); ++i) slots_[find_slot(corners_[i])] = i;
  }

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> slots_;  // numbers of corners, or k_none; a power of two, at least twice as many
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& file, const MeshFileOptions& options)
      : cursor_(text, file), options_(options) {}

  TriangleMesh parse() {
    for (; !cursor_.at_end(); cursor_.next_line())
      if (!cursor_.at_line_end()) statement();
    collect_vertices();
    return std::move(mesh_);
  }

 private:
  void statement();
  void face();
  Corner corner();
  std::uint32_t index(std::size_t count, std::string_view what);
  void collect_vertices();

  Cursor cursor_;
  const MeshFileOptions& options_;
  std::vector<Point3> positions_;
  std::vector<Vec2> uvs_;
  std::vector<Normal3> normals_;
  TriangleMesh mesh_;
  CornerTable vertices_;
  bool any_uv_ = false, any_normal_ = false;
};

void ObjParser::statement() {
  const char* const begin = cursor_.position();
  const std::string_view keyword = cursor_.word();
  if (keyword == "v") {
    const float x = cursor_.number(), y = cursor_.number(), z = cursor_.number();
    positions_.push_back(options_.to_world.apply(Point3{x, y, z}));
  } else if (keyword == "vt") {
    const float u = cursor_.number(), v = cursor_.at_line_end() ? 0 : cursor_.number();
    uvs_.push_back({u, options_.flip_tex_coords ? 1 - v : v});
  } else if (keyword == "vn") {
    const float x = cursor_.number(), y = cursor_.number(), z = cursor_.number();
    normals_.push_back(options_.to_world.apply(Normal3{x, y, z}));
  } else if (keyword == "f") {
    face();
  } else if (std::find(std::begin(k_ignored), std::end(k_ignored), keyword) == std::end(k_ignored)) {
    cursor_.fail(fmt::format("unknown statement \"{:.20}\"; polygons are given by v, vt, vn and f", keyword), begin);
  }
}

void ObjParser::face() {
  std::uint32_t first = 0, previous = 0;
  int count = 0;
  for (; !cursor_.at_line_end(); ++count) {
    if (vertices_.corners().size() == k_none) cursor_.fail("the mesh has too many vertices for 32-bit indices");
    const std::uint32_t current = vertices_.number(corner());
    if (count == 0) first = current;
    if (count >= 2) mesh_.triangles.push_back({first, previous, current});
    previous = current;
  }
  if (count < 3) cursor_.fail(fmt::format("a face needs at least three corners, not {}", count));
}

/// "1", "1/2", "1//3" or "1/2/3".
Corner ObjParser::corner() {
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
  const char* const begin = cursor_.position();
  long long number = 0;
  if (!cursor_.try_integer(number)) return k_none;
  const auto available = static_cast<long long>(count);
  if (number == 0 || number > available || number < -available)
    cursor_.fail(fmt::format("there is no {} {}: {} were given before this line", what, number, count), begin);
  return static_cast<std::uint32_t>(number > 0 ? number - 1 : available + number);
}

void ObjParser::collect_vertices() {
  const std::vector<Corner>& corners = vertices_.corners();
  mesh_.positions.reserve(corners.size());
  for (const Corner& corner : corners) mesh_.positions.push_back(positions_[corner.position]);
  if (any_uv_) {
    mesh_.uvs.reserve(corners.size());
    for (const Corner& corner : corners) mesh_.uvs.push_back(corner.uv == k_none ? Vec2() : uvs_[corner.uv]);
  }
  if (any_normal_ && !options_.face_normals) {
    mesh_.normals.reserve(corners.size());
    for (const Corner& corner : corners)
      mesh_.normals.push_back(corner.normal == k_none ? Normal3{0, 0, 0} : normals_[corner.normal]);
  }
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& file, const MeshFileOptions& options) {
  TriangleMesh mesh = ObjParser(text, file, options).parse();
  finish_normals(mesh, options);
  return mesh;
}

TriangleMesh load_obj(const std::filesystem::path& file, const MeshFileOptions& options) {
  return parse_obj(read_file(file), file.string(), options);
}

}  // namespace gradslc
