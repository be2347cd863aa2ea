#include "scene/loaders/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "scene/loaders/mesh_normals.h"
#include "scene/loaders/ply_header.h"

namespace gradslc {
namespace {

static_assert(std::endian::native == std::endian::little, "binary files are read on little-endian machines only");

/// Reads numbers of the text after the header, separated by blanks and line ends.
class AsciiReader {
 public:
  AsciiReader(std::string_view bytes, std::size_t position, const std::string& file)
      : bytes_(bytes), position_(position), file_(file) {}

  /// Fewest bytes that a value can take: a digit, and a blank before it.
  static std::size_t min_size(PlyType) { return 2; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  /// Of the next value.
  std::size_t position() {
    while (position_ < bytes_.size() && is_blank(bytes_[position_])) ++position_;
    return position_;
  }

  double read(PlyType) {
    position();
    const char* begin = bytes_.data() + position_;
    const char* const end = bytes_.data() + bytes_.size();
    if (begin == end) fail(position_, "the file ends too early: a number is needed here");
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [last, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc() || (last != end && !is_blank(*last))) fail(position_, "a number is needed here");
    position_ = static_cast<std::size_t>(last - bytes_.data());
    return value;
  }
  [[noreturn]] void fail(std::size_t position, std::string message) const {
    throw_input_error(position_in_text(bytes_, file_, position), std::move(message));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view bytes_;
  std::size_t position_;
  const std::string& file_;
};

/// Reads binary numbers.
class BinaryReader {
 public:
  BinaryReader(std::string_view bytes, std::size_t position, const std::string& file, bool big_endian)
      : bytes_(bytes), position_(position), file_(file), big_endian_(big_endian) {}

  static std::size_t min_size(PlyType type) { return ply_size(type); }
  std::size_t remaining() const { return bytes_.size() - position_; }
  std::size_t position() const { return position_; }

  double read(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return read_as<std::int8_t>();
      case PlyType::uint8:
        return read_as<std::uint8_t>();
      case PlyType::int16:
        return read_as<std::int16_t>();
      case PlyType::uint16:
        return read_as<std::uint16_t>();
      case PlyType::int32:
        return read_as<std::int32_t>();
      case PlyType::uint32:
        return read_as<std::uint32_t>();
      case PlyType::float32:
        return read_as<float>();
      case PlyType::float64:
        break;
    }
    return read_as<double>();
  }
  [[noreturn]] void fail(std::size_t position, const std::string& message) const {
    throw_input_error(file_, fmt::format("byte {}: {}", position, message));
  }

 private:
  template <class Number>
  double read_as() {
    std::array<char, sizeof(Number)> raw;
    if (remaining() < raw.size()) fail(position_, "the file ends too early");
    std::memcpy(raw.data(), bytes_.data() + position_, raw.size());
    position_ += raw.size();
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

  std::string_view bytes_;
  std::size_t position_;
  const std::string& file_;
  bool big_endian_;
};

constexpr std::size_t k_vertex_values = 8;  // x y z nx ny nz u v
constexpr std::size_t k_skipped = k_vertex_values;
constexpr std::array<std::string_view, 6> k_vertex_names = {"x", "y", "z", "nx", "ny", "nz"};
constexpr std::pair<std::string_view, std::string_view> k_uv_names[] = {
    {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};

/// What the properties of a vertex mean.
struct VertexLayout {
  std::vector<std::size_t> slots;  // by property: place in the vertex's values, or k_skipped
  bool has_normals = false, has_uvs = false;
};

bool is_list(const PlyProperty& property) { return property.count_type.has_value(); }

bool has_value(const PlyElement& element, std::string_view name) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [&](const PlyProperty& property) { return property.name == name && !is_list(property); });
}

VertexLayout vertex_layout(const PlyElement& vertex, const std::string& file) {
  std::vector<std::string_view> names(k_vertex_names.begin(), k_vertex_names.end());
  for (const std::string_view axis : {"x", "y", "z"})
    if (!has_value(vertex, axis)) throw_input_error(file, fmt::format("element vertex has no property {}", axis));
  VertexLayout layout;
  layout.has_normals = has_value(vertex, "nx") && has_value(vertex, "ny") && has_value(vertex, "nz");
  for (const auto& [u, v] : k_uv_names)
    if (!layout.has_uvs && has_value(vertex, u) && has_value(vertex, v)) {
      names.insert(names.end(), {u, v});
      layout.has_uvs = true;
    }
  for (const PlyProperty& property : vertex.properties) {
    const auto found = std::find(names.begin(), names.end(), property.name);
    const bool used = found != names.end() && !is_list(property);
    layout.slots.push_back(used ? static_cast<std::size_t>(found - names.begin()) : k_skipped);
  }
  return layout;
}

bool is_index_list(const PlyProperty& property) {
  return is_list(property) && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Reads the elements after the header.
template <class Reader>
class PlyBody {
 public:
  PlyBody(Reader reader, const PlyHeader& header, const std::string& file, const MeshFileOptions& options)
      : reader_(std::move(reader)), header_(header), options_(options) {
    const PlyElement* const vertex = header.find("vertex");
    const PlyElement* const face = header.find("face");
    if (!vertex) throw_input_error(file, "has no element vertex");
    if (!face || std::count_if(face->properties.begin(), face->properties.end(), is_index_list) != 1)
      throw_input_error(file, "needs an element face with one list vertex_indices (or vertex_index)");
    if (vertex->count >= std::numeric_limits<std::uint32_t>::max())
      throw_input_error(file, "has too many vertices for 32-bit indices");
    vertex_count_ = static_cast<std::uint32_t>(vertex->count);
    layout_ = vertex_layout(*vertex, file);
  }

  TriangleMesh read() {
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (!element.properties.empty()) {
        for (std::uint64_t i = 0; i < element.count; ++i)
          for (const PlyProperty& property : element.properties) skip(property);
      }
    }
    return std::move(mesh_);
  }

 private:
  /// A count that the file cannot hold is found before memory is asked for.
  void check_count(const PlyElement& element) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += Reader::min_size(is_list(property) ? *property.count_type : property.type);
    if (bytes > 0 && element.count > reader_.remaining() / bytes + 1)
      reader_.fail(reader_.position(),
                   fmt::format("{} of element {:.30} are declared, but the rest of the file has room "
                               "for {} at most",
                               element.count, element.name, reader_.remaining() / bytes + 1));
  }
  void read_vertices(const PlyElement& element) {
    mesh_.positions.reserve(element.count);
    if (layout_.has_normals) mesh_.normals.reserve(element.count);
    if (layout_.has_uvs) mesh_.uvs.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) read_vertex(element);
  }
  void read_vertex(const PlyElement& element) {
    std::array<float, k_vertex_values> v{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const std::size_t slot = layout_.slots[i];
      if (slot == k_skipped)
        skip(element.properties[i]);
      else
        v[slot] = read_float(element.properties[i].type);
    }
    mesh_.positions.push_back(options_.to_world.apply(Point3{v[0], v[1], v[2]}));
    if (layout_.has_normals) mesh_.normals.push_back(options_.to_world.apply(Normal3{v[3], v[4], v[5]}));
    if (layout_.has_uvs) mesh_.uvs.push_back({v[6], options_.flip_tex_coords ? 1 - v[7] : v[7]});
  }
  void read_faces(const PlyElement& element) {
    mesh_.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        if (is_index_list(property))
          read_polygon(property);
        else
          skip(property);
  }
  void read_polygon(const PlyProperty& property) {
    const std::size_t begin = reader_.position();
    const std::uint64_t corners = read_list_size(property);
    if (corners < 3) reader_.fail(begin, fmt::format("a face needs at least three corners, not {}", corners));
    const std::uint32_t first = read_index(property.type);
    std::uint32_t previous = read_index(property.type);
    for (std::uint64_t i = 2; i < corners; ++i) {
      const std::uint32_t current = read_index(property.type);
      mesh_.triangles.push_back({first, previous, current});
      previous = current;
    }
  }

  void skip(const PlyProperty& property) {
    const std::uint64_t values = is_list(property) ? read_list_size(property) : 1;
    for (std::uint64_t i = 0; i < values; ++i) reader_.read(property.type);
  }
  std::uint64_t read_list_size(const PlyProperty& property) {
    const std::size_t begin = reader_.position();
    const double size = reader_.read(*property.count_type);
    if (!(size >= 0 && size <= std::numeric_limits<std::uint32_t>::max() && size == std::floor(size)))
      reader_.fail(begin, "the length of a list must be a whole number, not negative");
    return static_cast<std::uint64_t>(size);
  }
  std::uint32_t read_index(PlyType type) {
    const std::size_t begin = reader_.position();
    const double index = reader_.read(type);
    if (!(index >= 0 && index < vertex_count_ && index == std::floor(index)))
      reader_.fail(begin, fmt::format("there is no vertex {}: there are {}, counted from 0", index, vertex_count_));
    return static_cast<std::uint32_t>(index);
  }
  float read_float(PlyType type) {
    const std::size_t begin = reader_.position();
    const double value = reader_.read(type);
    if (!(std::abs(value) <= double{std::numeric_limits<float>::max()}))
      reader_.fail(begin, fmt::format("a finite number is needed here, not {}", value));
    return static_cast<float>(value);
  }

  Reader reader_;
  const PlyHeader& header_;
  const MeshFileOptions& options_;
  VertexLayout layout_;
  std::uint32_t vertex_count_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& file, const MeshFileOptions& options) {
  const PlyHeader header = parse_ply_header(bytes, file);
  const auto read = [&](auto reader) { return PlyBody(std::move(reader), header, file, options).read(); };
  TriangleMesh mesh = header.format == PlyFormat::ascii
                          ? read(AsciiReader(bytes, header.size, file))
                          : read(BinaryReader(bytes, header.size, file, header.format == PlyFormat::binary_big_endian));
  finish_normals(mesh, options);
  return mesh;
}

TriangleMesh load_ply(const std::filesystem::path& file, const MeshFileOptions& options) {
  return parse_ply(read_file(file), file.string(), options);
}

}  // namespace gradslc
