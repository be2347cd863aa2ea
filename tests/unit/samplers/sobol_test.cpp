#include "samplers/sobol.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "support/random.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

static_assert(reverse_bits(0x00000001u) == 0x80000000u);
static_assert(reverse_bits(0x12345678u) == 0x1e6a2c48u);
static_assert(reverse_bits(reverse_bits(0xdeadbeefu)) == 0xdeadbeefu);

/// Sobol's second dimension by its definition: direction numbers of the polynomial x + 1 with m_1 = 1.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t direction = 0x80000000u, value = 0;
  for (; index != 0; index >>= 1) {
    if (index & 1) value ^= direction;
    direction ^= direction >> 1;
  }
  return value;
}

TEST(Sobol, SecondDimensionFollowsItsDirectionNumbers) {
  constexpr std::array<double, 8> published{0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
  for (std::uint32_t i = 0; i < published.size(); ++i)
    EXPECT_EQ(reverse_bits(multiply_by_pascal_matrix(i)) * 0x1p-32, published[i]);
  TestRandom random(1);
  for (int i = 0; i < 10000; ++i) {
    const auto index = static_cast<std::uint32_t>(random.bits());
    ASSERT_EQ(reverse_bits(multiply_by_pascal_matrix(index)), second_dimension(index)) << index;
  }
}

TEST(LaineKarras, PermutesTheLowBitsAmongThemselves) {
  TestRandom random(2);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const std::uint64_t key = random.bits();
    std::set<std::uint32_t> images;
    for (std::uint32_t x = 0; x < 256; ++x) {
      const std::uint32_t low = laine_karras_permutation(x, key) & 255;
      images.insert(low);
      const std::uint32_t high = static_cast<std::uint32_t>(random.bits()) << 8;
      ASSERT_EQ(laine_karras_permutation(x | high, key) & 255, low);
    }
    ASSERT_EQ(images.size(), 256u);
  }
}

// What makes an Owen scramble's estimates unbiased: each number is uniform over the keys. False alarm 0.1 %.
TEST(LaineKarras, IsUniformOverKeys) {
  constexpr std::array<std::uint32_t, 6> inputs{0, 1, 2, 0x80000000u, 0x55555555u, 0xffffffffu};
  for (const std::uint32_t x : inputs) {
    std::vector<double> low(256), high(256);
    for (std::uint64_t key = 0; key < 100'000; ++key) {
      const std::uint32_t y = laine_karras_permutation(x, mix64(key));
      low[y & 255] += 1;
      high[y >> 24] += 1;
    }
    EXPECT_GT(chi_square_uniform(low).p_value, sidak(1e-3, 2 * inputs.size())) << x;
    EXPECT_GT(chi_square_uniform(high).p_value, sidak(1e-3, 2 * inputs.size())) << x;
  }
}

// What makes its variance that of stratified sampling: numbers that share their k lowest bits and differ in the next
// still do so, and their bits above are independent. False alarm 0.1 %.
TEST(LaineKarras, PairsSplitAtTheirFirstDifferenceAndAreIndependentBeyond) {
  constexpr std::array<std::uint32_t, 4> inputs{0, 5, 0x2au, 0x12345678u};
  constexpr std::array<int, 4> first_differences{0, 1, 4, 9};
  for (const std::uint32_t x : inputs)
    for (const int bit : first_differences) {
      const std::uint32_t partner = x ^ 1u << bit;
      std::vector<double> beyond(16);
      for (std::uint64_t key = 0; key < 100'000; ++key) {
        const std::uint32_t difference =
            laine_karras_permutation(x, mix64(key)) ^ laine_karras_permutation(partner, mix64(key));
        ASSERT_EQ(std::countr_zero(difference), bit);
        beyond[difference >> (bit + 1) & 15] += 1;
      }
      EXPECT_GT(chi_square_uniform(beyond).p_value, sidak(1e-3, inputs.size() * first_differences.size()))
          << x << " " << bit;
    }
}

TEST(Sobol, ShuffleKeepsAlignedBlocksTogether) {
  TestRandom random(4);
  for (int repetition = 0; repetition < 50; ++repetition) {
    const std::uint64_t key = random.bits();
    std::set<std::uint32_t> images;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const std::uint32_t index = sobol_shuffled_index(key, reverse_bits(128 + i));
      images.insert(index & 63);
      ASSERT_EQ(index >> 6, sobol_shuffled_index(key, reverse_bits(128u)) >> 6);
    }
    ASSERT_EQ(images.size(), 64u);
  }
}

}  // namespace
}  // namespace gradslc
