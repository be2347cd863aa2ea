#include "core/image.h"

#include <gtest/gtest.h>

#include <numeric>

namespace gradslc {
namespace {

TEST(Image, IsRowMajorFromTheTopLeft) {
  Image<int> image({3, 2});
  std::iota(image.begin(), image.end(), 0);
  EXPECT_EQ(image(0, 0), 0);
  EXPECT_EQ(image(2, 0), 2);
  EXPECT_EQ(image(0, 1), 3);
  EXPECT_EQ((image[Pixel{2, 1}]), 5);
  EXPECT_EQ(image[std::size_t{4}], 4);
  EXPECT_EQ(image.width(), 3);
  EXPECT_EQ(image.height(), 2);
  EXPECT_EQ(image.size(), 6u);
}

TEST(Image, FillsAndCompares) {
  const Image<float> one({2, 2}, 1.0f);
  Image<float> other({2, 2}, 1.0f);
  EXPECT_EQ(one, other);
  other(1, 1) = 2;
  EXPECT_NE(one, other);
  EXPECT_NE(one, Image<float>({4, 1}, 1.0f));
  EXPECT_TRUE(Image<float>().empty());
}

TEST(Resolution, ContainsItsPixelsOnlyAndCountsBeyond32Bits) {
  constexpr Resolution resolution{4, 3};
  EXPECT_TRUE(resolution.contains({3, 2}));
  for (const Pixel outside : {Pixel{-1, 0}, Pixel{0, -1}, Pixel{4, 0}, Pixel{0, 3}})
    EXPECT_FALSE(resolution.contains(outside));
  EXPECT_EQ((Resolution{100'000, 100'000}.pixels()), 10'000'000'000u);
  EXPECT_EQ((Resolution{100'000, 100'000}.index({5, 99'999})), 9'999'900'005u);
}

}  // namespace
}  // namespace gradslc
