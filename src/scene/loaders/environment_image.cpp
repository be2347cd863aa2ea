#include "scene/loaders/environment_image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include "core/error.h"

namespace gradslc {

RgbImage read_environment_image(const std::filesystem::path& path) {
  constexpr int k_max_size = 65536;
  const auto fail = [&](const std::string& why) {
    throw_input_error(path.string(), "not a readable EXR image: " + why);
  };
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const Resolution size{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
    if (size.width > k_max_size || size.height > k_max_size) fail("it is too large");
    RgbImage image(size);
    Imf::FrameBuffer buffer;
    const auto width = static_cast<std::size_t>(size.width);
    for (const auto& [name, first] :
         {std::pair{"R", &image[0].r}, std::pair{"G", &image[0].g}, std::pair{"B", &image[0].b}}) {
      if (!file.header().channels().findChannel(name)) fail(fmt::format("it has no channel {}", name));
      buffer.insert(name,
                    Imf::Slice::Make(Imf::FLOAT, first, window.min, size.width, 1, sizeof(Rgb), sizeof(Rgb) * width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& problem) {
    fail(problem.what());
  }
  return {};
}

}  // namespace gradslc
