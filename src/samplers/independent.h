#pragma once

#include <cstdint>

#include "core/hash.h"

namespace gradslc {

/// 64 independent random bits for each (key, sample): output number `sample` of SplitMix64 seeded with `key`
/// (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
constexpr std::uint64_t independent_bits(std::uint64_t key, std::uint32_t sample) {
  return mix64(key + (sample + std::uint64_t{1}) * k_golden_gamma);
}

}  // namespace gradslc
