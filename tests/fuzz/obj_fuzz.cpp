// Whatever the bytes, the OBJ parser gives a consistent mesh or an Error.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "scene/loaders/obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool face_normals : {false, true}) {
    gradslc::TriangleMesh mesh;
    try {
      mesh = gradslc::parse_obj(text, "fuzz.obj", {.face_normals = face_normals, .flip_tex_coords = true});
    } catch (const gradslc::Error&) {
      continue;
    }
    gradslc::check_mesh(mesh);  // an Error here is a fault of the parser: the fuzzer reports it
  }
  return 0;
}
