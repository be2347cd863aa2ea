#include "shifts/block_partition.h"

#include <gtest/gtest.h>

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
