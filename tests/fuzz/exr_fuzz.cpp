// Whatever the bytes, the EXR reader gives images of one size or an Error.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "core/exr.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const gradslc::ExrImage exr =
        gradslc::decode_exr(std::string(reinterpret_cast<const char*>(data), size), "fuzz.exr");
    if (exr.image.empty()) std::abort();
    for (const auto& [name, layer] : exr.layers)
      if (std::visit([](const auto& image) { return image.resolution(); }, layer) != exr.image.resolution())
        std::abort();
  } catch (const gradslc::Error&) {
  }
  return 0;
}
