#include "materials/texels.h"

#include <limits>
#include <type_traits>

namespace gradslc {

RgbImage linear_rgb(const Texels& texels) {
  RgbImage image(texels.resolution);
  const auto channels = static_cast<std::size_t>(texels.channels);
  const std::size_t green = channels >= 3 ? 1 : 0, blue = channels >= 3 ? 2 : 0;
  std::visit(
      [&](const auto& values) {
        using Value = std::decay_t<decltype(values[0])>;
        const auto linear = [](Value value) {
          if constexpr (std::is_floating_point_v<Value>)
            return value;
          else
            return srgb_to_linear(static_cast<float>(value) / static_cast<float>(std::numeric_limits<Value>::max()));
        };
        for (std::size_t i = 0; i < image.size(); ++i) {
          const auto* texel = &values[i * channels];
          image[i] = {linear(texel[0]), linear(texel[green]), linear(texel[blue])};
        }
      },
      texels.values);
  return image;
}

}  // namespace gradslc
