// Whatever the bytes, the reader of .serialized files gives a consistent mesh or an Error. The input is tried as a
// file, and as the decompressed data of a mesh: no mutation would survive zlib's checksum.

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "core/error.h"
#include "scene/loaders/serialized.h"

namespace {

void load(const std::string& file, int shape_index) {
  for (const bool face_normals : {false, true}) {
    gradslc::TriangleMesh mesh;
    std::istringstream stream(file);
    try {
      mesh = gradslc::parse_serialized(stream, "fuzz.serialized", shape_index, {.face_normals = face_normals});
    } catch (const gradslc::Error&) {
      continue;
    }
    gradslc::check_mesh(mesh);  // an Error here is a fault of the reader: the fuzzer reports it
  }
}

std::string as_file(const std::string& mesh, char version) {
  uLongf size = compressBound(static_cast<uLong>(mesh.size()));
  std::string compressed(size, '\0');
  compress(reinterpret_cast<Bytef*>(compressed.data()), &size, reinterpret_cast<const Bytef*>(mesh.data()),
           static_cast<uLong>(mesh.size()));
  compressed.resize(size);
  const std::string one_mesh("\1\0\0\0", 4);
  return std::string("\x1c\4", 2) + version + '\0' + compressed + std::string(version == 4 ? 8 : 4, '\0') + one_mesh;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  load(bytes, 0);
  load(bytes, 1);
  load(as_file(bytes, 3), 0);
  load(as_file(bytes, 4), 0);
  return 0;
}
