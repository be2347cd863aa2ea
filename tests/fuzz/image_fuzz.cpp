// Whatever the bytes, the image reader gives consistent texels or an Error; their first bytes choose the format.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/error.h"
#include "materials/bitmap.h"
#include "scene/loaders/images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gradslc::Texels texels;
  try {
    texels = gradslc::decode_image(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  } catch (const gradslc::Error&) {
    return 0;
  }
  const std::size_t values = std::visit([](const auto& v) { return v.size(); }, texels.values);
  if (values == 0 || values != texels.resolution.pixels() * static_cast<std::size_t>(texels.channels)) std::abort();
  const auto bitmap =
      gradslc::make_bitmap(std::make_shared<const gradslc::Texels>(std::move(texels)), {.encoding = {1}});
  if (!gradslc::is_finite(bitmap->eval({0.9f, -7.3f})) || !gradslc::is_finite(bitmap->max_value())) std::abort();
  return 0;
}
