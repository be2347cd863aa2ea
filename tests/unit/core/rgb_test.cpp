#include "core/rgb.h"

#include <gtest/gtest.h>

#include <limits>

namespace gradslc {
namespace {

TEST(Rgb, Arithmetic) {
  const Rgb a(1, 2, 3), b(0.5f, 4, 2);
  EXPECT_EQ(a + b, Rgb(1.5f, 6, 5));
  EXPECT_EQ(a - b, Rgb(0.5f, -2, 1));
  EXPECT_EQ(a * b, Rgb(0.5f, 8, 6));
  EXPECT_EQ(2 * a, a / 0.5f);
  EXPECT_EQ(max_channel(b), 4);
  EXPECT_EQ(a[0] + 10 * a[1] + 100 * a[2], 321);
  EXPECT_TRUE(is_black(Rgb()));
  EXPECT_FALSE(is_black(Rgb(0, 0, 1e-30f)));
}

TEST(Rgb, FiniteInEveryChannel) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(is_finite(Rgb(1, -2, 3e38f)));
  for (const Rgb bad : {Rgb(nan, 0, 0), Rgb(0, infinity, 0), Rgb(0, 0, -infinity)}) EXPECT_FALSE(is_finite(bad));
}

TEST(Luminance, OfWhiteIsOne) { EXPECT_FLOAT_EQ(luminance(Rgb(1)), 1); }

TEST(SrgbEncoding, HasKnownValuesAndInverts) {
  EXPECT_NEAR(srgb_to_linear(0.5f), 0.21404114f, 1e-6f);
  EXPECT_FLOAT_EQ(srgb_to_linear(0.04f), 0.04f / 12.92f);
  EXPECT_FLOAT_EQ(linear_to_srgb(7), 1);
  EXPECT_LE(linear_to_srgb(7), 1);
  EXPECT_EQ(linear_to_srgb(-1), 0);
  for (int i = 0; i <= 255; ++i) {
    const float code = static_cast<float>(i) / 255;
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(code)), code, 1e-5f);
  }
}

}  // namespace
}  // namespace gradslc
