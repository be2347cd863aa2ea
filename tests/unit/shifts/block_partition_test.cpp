#include "shifts/block_partition.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "shifts/stencil.h"

namespace gradslc {
namespace {

TEST(BlockPartition, CoversEveryPixelOnceForEveryOffset) {
  const Resolution image{13, 7}, block{4, 3};
  for (int oy = 0; oy < block.height; ++oy)
    for (int ox = 0; ox < block.width; ++ox) {
      const Vec2 u{(static_cast<float>(ox) + 0.5f) / 4, (static_cast<float>(oy) + 0.5f) / 3};
      const BlockPartition partition(image, block, u);
      Image<int> covered(image);
      for (std::size_t i = 0; i < partition.size(); ++i) {
        const auto [first, size] = partition.block(i);
        EXPECT_GE(size.width, 1);
        EXPECT_GE(size.height, 1);
        EXPECT_LE(size.width, block.width);
        EXPECT_LE(size.height, block.height);
        for (std::size_t k = 0; k < size.pixels(); ++k) ++covered[first + size.pixel(k)];
      }
      for (const int count : covered) EXPECT_EQ(count, 1) << ox << "," << oy;
    }
}

TEST(BlockPartition, EveryPairIsSplitByTheSameShareOfOffsets) {
  const Resolution image{9, 5}, block{4, 2};
  Image<int> together(image);
  for (int ox = 0; ox < block.width; ++ox) {
    const BlockPartition partition(image, block, {(static_cast<float>(ox) + 0.5f) / 4, 0});
    for (std::size_t i = 0; i < partition.size(); ++i) {
      const auto [first, size] = partition.block(i);
      for (std::size_t k = 0; k < size.pixels(); ++k)
        if (const Pixel local = size.pixel(k); local.x + 1 < size.width) ++together[first + local];
    }
  }
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x + 1 < image.width; ++x) EXPECT_EQ(together(x, y), block.width - 1);
}

// The smaller blocks within the larger ones are a partition with the same offset: whole but for the image's border.
TEST(BlockPartition, SmallerBlocksTileTheLargerOnes) {
  constexpr Resolution k_image{29, 23}, k_large{12, 8}, k_small{3, 4};
  for (int step = 0; step < 96; ++step) {
    const Vec2 u{static_cast<float>(step % 12) / 12 + 0.01f, static_cast<float>(step / 12) / 8 + 0.01f};
    const BlockPartition partition(k_image, k_large, u);
    std::map<int, int> columns,
        rows;  // where small blocks begin, modulo their side, away from the left and upper border
    std::vector<int> covered(k_image.pixels(), 0);
    for (std::size_t i = 0; i < partition.size(); ++i)
      partition.for_each_within(partition.block(i), k_small, [&](const BlockPartition::Block& block) {
        for (std::size_t k = 0; k < block.size.pixels(); ++k)
          ++covered[k_image.index(block.first + block.size.pixel(k))];
        EXPECT_LE(block.size.width, k_small.width);
        EXPECT_LE(block.size.height, k_small.height);
        if (block.first.x > 0) ++columns[block.first.x % k_small.width];
        if (block.first.y > 0) ++rows[block.first.y % k_small.height];
      });
    EXPECT_EQ(columns.size(), 1u) << step;
    EXPECT_EQ(rows.size(), 1u) << step;
    for (const int count : covered) EXPECT_EQ(count, 1);
  }
}

TEST(BlockPartition, LargestRandomNumberIsInRange) {
  const BlockPartition partition({10, 10}, {4, 4}, {0.99999994f, 0.99999994f});
  EXPECT_EQ(partition.block(0).size, (Resolution{1, 1}));
}

TEST(Stencil, BaseFirstThenItsNeighbours) {
  EXPECT_EQ(stencil_offsets(Stencil::forward).size(), 3u);
  EXPECT_EQ(stencil_offsets(Stencil::symmetric).size(), 5u);
  EXPECT_EQ(k_stencil_offsets[k_base], (Pixel{0, 0}));
  EXPECT_EQ(k_stencil_offsets[k_right], (Pixel{1, 0}));
  EXPECT_EQ(k_stencil_offsets[k_lower], (Pixel{0, 1}));
  EXPECT_EQ(k_stencil_offsets[k_left], (Pixel{-1, 0}));
  EXPECT_EQ(k_stencil_offsets[k_upper], (Pixel{0, -1}));
}

}  // namespace
}  // namespace gradslc
