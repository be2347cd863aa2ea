#pragma once

#include <cstdint>

namespace gradslc {

/// 2^64 divided by the golden ratio, odd: SplitMix64's step, which keeps multiples of it far apart.
constexpr std::uint64_t k_golden_gamma = 0x9e3779b97f4a7c15u;

/// Finaliser of SplitMix64 (Steele, Lea and Flood 2014; constants of Stafford's variant 13): a bijection of 64 bits
/// that mixes well.
constexpr std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Both halves of the 128-bit product, one added to the other without carries: mixes bits that are mixed already at the
/// price of one multiplication (the round of Wang Yi's wyhash). `factor` odd.
constexpr std::uint64_t fold_multiply(std::uint64_t x, std::uint64_t factor) {
  __extension__ using Product = unsigned __int128;
  const Product product = static_cast<Product>(x) * factor;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// A hash of several integers in order; hash_combine(a, b) != hash_combine(b, a).
constexpr std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b) {
  return mix64(mix64(a + k_golden_gamma) ^ (b + 0x632be59bd9b4e019u));
}
template <class... Rest>
constexpr std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b, Rest... rest) {
  return hash_combine(hash_combine(a, b), static_cast<std::uint64_t>(rest)...);
}

/// A float in [0,1) from the top 24 bits.
constexpr float to_unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace gradslc
