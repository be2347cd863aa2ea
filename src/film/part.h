#pragma once

#include <cstdint>

namespace gradslc {

/// How light came to the camera (DESIGN 4): the parts of an image, which sum to it.
enum class Part : std::uint8_t { direct, vpl, compensation, specular, prefix };
constexpr int k_part_count = 5;
constexpr const char* k_part_names[k_part_count] = {"direct", "vpl", "compensation", "specular", "prefix"};

}  // namespace gradslc
