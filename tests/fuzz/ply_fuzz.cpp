// Whatever the bytes, the PLY parser gives a consistent mesh or an Error.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "scene/loaders/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const gradslc::MeshFileOptions& options :
       {gradslc::MeshFileOptions{}, {.face_normals = true, .flip_tex_coords = true}, {.max_smooth_angle = 30}}) {
    gradslc::TriangleMesh mesh;
    try {
      mesh = gradslc::parse_ply(bytes, "fuzz.ply", options);
    } catch (const gradslc::Error&) {
      continue;
    }
    gradslc::check_mesh(mesh);  // an Error here is a fault of the parser: the fuzzer reports it
  }
  return 0;
}
