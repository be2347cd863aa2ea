#include "core/hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "support/statistics.h"

namespace gradslc {
namespace {

// The first outputs of SplitMix64 from state 0 and 1234567, as published with java.util.SplittableRandom's algorithm.
TEST(Mix64, IsSplitMix64) {
  EXPECT_EQ(mix64(k_golden_gamma), 0xe220a8397b1dcdafu);
  EXPECT_EQ(mix64(2 * k_golden_gamma), 0x6e789e6aa1b965f4u);
  EXPECT_EQ(mix64(1234567 + k_golden_gamma), 6457827717110365317u);
}

TEST(HashCombine, DependsOnOrderAndNumberOfArguments) {
  std::set<std::uint64_t> seen;
  std::size_t made = 0;
  for (std::uint64_t a = 0; a < 64; ++a)
    for (std::uint64_t b = 0; b < 64; ++b) {
      seen.insert(hash_combine(a, b));
      seen.insert(hash_combine(a, b, 0));
      seen.insert(hash_combine(0, a, b));
      made += 3;
    }
  EXPECT_EQ(seen.size(), made - 64);  // hash_combine(0, a, 0) is written in two ways
}

// Each bit of the input flips each bit of the output with probability 1/2. False alarm 0.1 %.
TEST(HashCombine, Avalanches) {
  for (int bit = 0; bit < 64; ++bit) {
    Moments first, second;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const std::uint64_t flipped = i ^ std::uint64_t{1} << bit;
      first.add(std::popcount(hash_combine(i, 7) ^ hash_combine(flipped, 7)));
      second.add(std::popcount(hash_combine(7, i) ^ hash_combine(7, flipped)));
    }
    EXPECT_GT(first.p_value(32), sidak(1e-3, 128)) << bit;
    EXPECT_GT(second.p_value(32), sidak(1e-3, 128)) << bit;
  }
}

}  // namespace
}  // namespace gradslc
