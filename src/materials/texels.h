#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "core/image.h"

namespace gradslc {

/// The pixels of an image as its file holds them, row-major from the top left, channels interleaved. Integers mean
/// [0,1], as a rule sRGB-encoded; floats are linear.
struct Texels {
  Resolution resolution;
  int channels = 3;  ///< 1: grey; 2: grey, alpha; 3: RGB; 4: RGB, alpha
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> values;

  std::size_t memory_bytes() const {
    return std::visit([](const auto& v) { return v.size() * sizeof(v[0]); }, values);
  }
};

/// The image in linear RGB: integers decoded from sRGB, grey for all three channels, without alpha.
RgbImage linear_rgb(const Texels& texels);

}  // namespace gradslc
