#pragma once
// The first two dimensions of Sobol's sequence, shuffled and Owen-scrambled by hashing (Burley 2020, "Practical
// Hash-based Owen Scrambling", JCGT 9(4)). Each pair of dimensions that is asked for is such a sequence with keys of
// its own ("padding"): a (0,2)-sequence in base 2 by itself, unrelated to all others.

#include <cstdint>

#include "core/hash.h"

namespace gradslc {

constexpr std::uint64_t reverse_bits(std::uint64_t x) {
  x = __builtin_bswap64(x);
  x = (x & 0x0f0f0f0f0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0f0f0f0f0fu);
  x = (x & 0x3333333333333333u) << 2 | (x >> 2 & 0x3333333333333333u);
  return (x & 0x5555555555555555u) << 1 | (x >> 1 & 0x5555555555555555u);
}
constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  return static_cast<std::uint32_t>(reverse_bits(std::uint64_t{x}) >> 32);
}

/// A random permutation of 32-bit integers in which each bit depends on itself and the lower ones only: an Owen
/// scramble of the reversed bits. Laine and Karras 2011 ("Stratified Sampling for Stochastic Transparency") with the
/// steps and constants of Vegdahl 2021 ("Building a Better LK Hash"), but 32 key bits each for the sum and the product,
/// where his variant reuses half of 32: so each number is exactly uniform over the keys.
constexpr std::uint32_t laine_karras_permutation(std::uint32_t x, std::uint64_t key) {
  x ^= x * 0x3d20adeau;
  x += static_cast<std::uint32_t>(key);
  x *= static_cast<std::uint32_t>(key >> 32) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Sobol's second dimension before the radical inversion: product with Pascal's triangle modulo 2, whose entry (r, c)
/// is odd exactly where the bits of r are among those of c (Lucas), and which is a Kronecker power of ((1 1) (0 1)).
constexpr std::uint32_t multiply_by_pascal_matrix(std::uint32_t x) {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ x >> 16;
}

/// Keys of the coordinates' scrambles, made of the shuffle's.
constexpr std::uint64_t sobol_key_of_x(std::uint64_t key) { return fold_multiply(key, 0xd1342543de82ef95u); }
constexpr std::uint64_t sobol_key_of_y(std::uint64_t key) { return fold_multiply(key, 0xaf251af3b0f025b5u); }

struct SobolPoint {
  std::uint32_t x, y;  ///< coordinates in [0,1) times 2^32
};

/// The position in the sequence of a sample, whose number's bits come in reverse: aligned blocks of 2^k samples keep
/// together, in another order.
constexpr std::uint32_t sobol_shuffled_index(std::uint64_t key, std::uint32_t reversed_sample) {
  return reverse_bits(laine_karras_permutation(reversed_sample, key));
}

/// Point of a sample, as above: any aligned block of 2^k samples has one point in each elementary interval of area
/// 2^-k.
constexpr SobolPoint sobol_point(std::uint64_t key, std::uint32_t reversed_sample) {
  const std::uint32_t index = sobol_shuffled_index(key, reversed_sample);
  const std::uint32_t x = laine_karras_permutation(index, sobol_key_of_x(key));
  const std::uint32_t y = laine_karras_permutation(multiply_by_pascal_matrix(index), sobol_key_of_y(key));
  const std::uint64_t both = reverse_bits(std::uint64_t{y} << 32 | x);
  return {static_cast<std::uint32_t>(both >> 32), static_cast<std::uint32_t>(both)};
}

/// Coordinate x of that point.
constexpr std::uint32_t sobol_coordinate(std::uint64_t key, std::uint32_t reversed_sample) {
  const std::uint32_t index = sobol_shuffled_index(key, reversed_sample);
  return reverse_bits(laine_karras_permutation(index, sobol_key_of_x(key)));
}

}  // namespace gradslc
