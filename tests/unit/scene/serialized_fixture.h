#pragma once
// Files in Mitsuba's .serialized format, made byte by byte.

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace gradslc::test {

template <class Number>
void append(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

struct SerializedMesh {
  std::uint32_t flags = 0x1000;
  std::string name = "mesh";
  std::uint64_t vertices = 3, triangles = 1;
  std::vector<double> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0};  ///< positions, then normals, uvs, colours
  std::vector<std::uint32_t> indices = {0, 1, 2};
};

inline std::string compress(const std::string& data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string out(size, '\0');
  ::compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
             static_cast<uLong>(data.size()));
  out.resize(size);
  return out;
}

/// The mesh with its uncompressed header.
inline std::string serialize(const SerializedMesh& mesh, std::uint16_t version) {
  std::string data;
  append(data, mesh.flags);
  if (version == 4) data.append(mesh.name.c_str(), mesh.name.size() + 1);
  append(data, mesh.vertices);
  append(data, mesh.triangles);
  for (const double number : mesh.numbers) {
    if (mesh.flags & 0x2000)
      append(data, number);
    else
      append(data, static_cast<float>(number));
  }
  for (const std::uint32_t index : mesh.indices) append(data, index);
  std::string bytes;
  append(bytes, std::uint16_t{0x041c});
  append(bytes, version);
  return bytes + compress(data);
}

/// A file of several meshes with its dictionary.
inline std::string serialized_file(const std::vector<SerializedMesh>& meshes, std::uint16_t version) {
  std::string file;
  std::vector<std::uint64_t> offsets;
  for (const SerializedMesh& mesh : meshes) {
    offsets.push_back(file.size());
    file += serialize(mesh, version);
  }
  for (const std::uint64_t offset : offsets) {
    if (version == 4)
      append(file, offset);
    else
      append(file, static_cast<std::uint32_t>(offset));
  }
  append(file, static_cast<std::uint32_t>(meshes.size()));
  return file;
}

}  // namespace gradslc::test
