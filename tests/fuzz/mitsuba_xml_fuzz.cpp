// Whatever the bytes, the scene loader gives a scene or an Error.

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "scene/loaders/loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const bool permissive : {false, true}) {
    gradslc::LoadOptions options;
    options.permissive = permissive;
    try {
      // The folder does not exist, so that includes and meshes cannot be found.
      for (const gradslc::TriangleMesh& mesh :
           gradslc::load_scene_text(text, "no-such-folder/scene.xml", options).meshes)
        gradslc::check_mesh(mesh);
    } catch (const gradslc::Error&) {
    }
  }
  return 0;
}
