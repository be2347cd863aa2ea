#include "scene/loaders/serialized.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <limits>
#include <vector>

#include "core/error.h"
#include "scene/loaders/inflate_stream.h"
#include "scene/loaders/mesh_normals.h"

namespace gradslc {
namespace {

static_assert(std::endian::native == std::endian::little, "serialized meshes are read on little-endian machines only");

constexpr std::uint16_t k_magic = 0x041c;
constexpr std::size_t k_header_size = 4;
constexpr std::size_t k_step = 1u << 20;  // numbers read at once: memory follows what the file really holds

constexpr std::size_t k_max_name = 65536;

constexpr std::uint32_t k_has_normals = 0x1, k_has_uvs = 0x2, k_has_colours = 0x8, k_face_normals = 0x10,
                        k_single = 0x1000, k_double = 0x2000;

template <class Number>
Number read_at(std::istream& stream, std::size_t offset, const std::string& file) {
  Number value{};
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(offset));
  if (!stream.read(reinterpret_cast<char*>(&value), sizeof(value)))
    throw_input_error(file, fmt::format("byte {}: the file ends too early", offset));
  return value;
}

/// Version of the mesh that begins at `offset`.
int read_version(std::istream& stream, std::size_t offset, const std::string& file) {
  if (read_at<std::uint16_t>(stream, offset, file) != k_magic)
    throw_input_error(file, fmt::format("byte {}: no serialized mesh begins here: it would begin with 1c 04", offset));
  const auto version = read_at<std::uint16_t>(stream, offset + 2, file);
  if (version != 3 && version != 4)
    throw_input_error(file, fmt::format("byte {}: version {} is not supported, only 3 and 4 are", offset + 2, version));
  return version;
}

struct Extent {
  std::size_t begin = 0, end = 0;  // bytes of the file
};

/// Where a mesh stands, by the dictionary at the end of the file.
Extent find_mesh(std::istream& stream, std::size_t file_size, int version, int shape_index, const std::string& file) {
  const std::size_t entry_size = version == 4 ? 8 : 4;
  if (file_size < k_header_size + 4) throw_input_error(file, "is too short for a serialized mesh and its dictionary");
  const std::size_t meshes = read_at<std::uint32_t>(stream, file_size - 4, file);
  const std::size_t room = (file_size - 4) / entry_size;
  if (meshes == 0 || meshes > room)
    throw_input_error(file, fmt::format("byte {}: the dictionary cannot have {} meshes", file_size - 4, meshes));
  const auto index = static_cast<std::size_t>(shape_index);
  if (index >= meshes)
    throw_input_error(file, fmt::format("has no mesh {}: there are {}, counted from 0", shape_index, meshes));
  const std::size_t dictionary = file_size - 4 - meshes * entry_size;
  const auto offset = [&](std::size_t i) -> std::uint64_t {
    if (i == meshes) return dictionary;
    const std::size_t entry = dictionary + i * entry_size;
    return version == 4 ? read_at<std::uint64_t>(stream, entry, file) : read_at<std::uint32_t>(stream, entry, file);
  };
  const std::uint64_t begin = offset(index), end = offset(index + 1);
  if (begin >= dictionary || end > dictionary || end < begin || end - begin < k_header_size)
    throw_input_error(file, fmt::format("byte {}: mesh {} cannot stand from byte {} to {}",
                                        dictionary + index * entry_size, shape_index, begin, end));
  return {static_cast<std::size_t>(begin), static_cast<std::size_t>(end)};
}

/// Reads one mesh from its decompressed data.
class MeshReader {
 public:
  MeshReader(InflateStream& data, int version, const MeshFileOptions& options) : data_(data), options_(options) {
    flags_ = read<std::uint32_t>();
    if (has(k_single) == has(k_double)) data_.fail("the flags must say either single or double precision");
    if (version == 4) skip_name();
    vertices_ = read<std::uint64_t>();
    triangles_ = read<std::uint64_t>();
    check_counts();
  }

  bool face_normals() const { return has(k_face_normals); }
  TriangleMesh read_mesh() {
    TriangleMesh mesh;
    read_vectors<3>(vertices_, [&](const std::array<float, 3>& v) {
      mesh.positions.push_back(options_.to_world.apply(Point3{v[0], v[1], v[2]}));
    });
    if (has(k_has_normals))
      read_vectors<3>(vertices_, [&](const std::array<float, 3>& v) {
        mesh.normals.push_back(options_.to_world.apply(Normal3{v[0], v[1], v[2]}));
      });
    if (has(k_has_uvs))
      read_vectors<2>(vertices_, [&](const std::array<float, 2>& v) {
        mesh.uvs.push_back({v[0], options_.flip_tex_coords ? 1 - v[1] : v[1]});
      });
    if (has(k_has_colours)) read_vectors<3>(vertices_, [](const std::array<float, 3>&) {});
    read_indices(mesh);
    return mesh;
  }

 private:
  bool has(std::uint32_t flag) const { return (flags_ & flag) != 0; }
  template <class Number>
  Number read() {
    Number value{};
    data_.read(&value, sizeof(value));
    return value;
  }
  void skip_name() {
    for (std::size_t size = 0; read<char>() != 0; ++size)
      if (size == k_max_name) data_.fail(fmt::format("the mesh's name is longer than {} bytes", k_max_name));
  }
  void check_counts() const {
    if (vertices_ >= std::numeric_limits<std::uint32_t>::max())
      data_.fail(fmt::format("{} vertices are too many for 32-bit indices", vertices_));
    const std::uint64_t number_size = has(k_double) ? 8 : 4;
    const std::uint64_t numbers = 3u + (has(k_has_normals) ? 3u : 0u) + (has(k_has_uvs) ? 2u : 0u);
    const std::uint64_t room = data_.max_remaining();
    if (vertices_ > room / (numbers * number_size) || triangles_ > room / sizeof(TriangleMesh::triangles[0]))
      data_.fail(fmt::format("{} vertices and {} triangles are declared, more than the compressed data can hold",
                             vertices_, triangles_));
  }

  template <std::size_t Size, class Use>
  void read_vectors(std::size_t count, const Use& use) {
    if (has(k_double))
      read_vectors_of<double, Size>(count, use);
    else
      read_vectors_of<float, Size>(count, use);
  }
  template <class Number, std::size_t Size, class Use>
  void read_vectors_of(std::size_t count, const Use& use) {
    std::vector<std::array<Number, Size>> raw;
    for (std::size_t done = 0; done < count; done += raw.size()) {
      raw.resize(std::min(count - done, k_step));
      data_.read(raw.data(), raw.size() * sizeof(raw[0]));
      for (const std::array<Number, Size>& vector : raw) {
        std::array<float, Size> narrow;
        for (std::size_t i = 0; i < Size; ++i) narrow[i] = finite(vector[i]);
        use(narrow);
      }
    }
  }
  template <class Number>
  float finite(Number value) const {
    if (!(std::abs(value) <= Number{std::numeric_limits<float>::max()}))
      data_.fail(fmt::format("a vertex has the value {}, which is not a finite number", value));
    return static_cast<float>(value);
  }
  void read_indices(TriangleMesh& mesh) {
    for (std::size_t done = 0; done < triangles_;) {
      const std::size_t step = std::min<std::size_t>(triangles_ - done, k_step);
      mesh.triangles.resize(done + step);
      data_.read(mesh.triangles.data() + done, step * sizeof(mesh.triangles[0]));
      done += step;
    }
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle)
        if (vertex >= vertices_)
          data_.fail(fmt::format("there is no vertex {}: there are {}, counted from 0", vertex, vertices_));
  }

  InflateStream& data_;
  const MeshFileOptions& options_;
  std::uint32_t flags_ = 0;
  std::uint64_t vertices_ = 0, triangles_ = 0;
};

}  // namespace

TriangleMesh parse_serialized(std::istream& stream, const std::string& file, int shape_index,
                              const MeshFileOptions& options) {
  stream.seekg(0, std::ios::end);
  const auto file_size = static_cast<std::size_t>(std::max<std::streamoff>(stream.tellg(), 0));
  const int first_version = read_version(stream, 0, file);
  const Extent extent = find_mesh(stream, file_size, first_version, shape_index, file);
  const int version = read_version(stream, extent.begin, file);
  InflateStream data(stream, extent.end - extent.begin - k_header_size, file);
  MeshReader reader(data, version, options);
  TriangleMesh mesh = reader.read_mesh();
  MeshFileOptions normals = options;
  normals.face_normals |= reader.face_normals();
  finish_normals(mesh, normals);
  return mesh;
}

TriangleMesh load_serialized(const std::filesystem::path& file, int shape_index, const MeshFileOptions& options) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw_input_error(file.string(), "cannot be opened");
  return parse_serialized(stream, file.string(), shape_index, options);
}

}  // namespace gradslc
