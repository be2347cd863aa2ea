#include "materials/checkerboard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "materials/bitmap.h"

namespace gradslc {
namespace {

const Texture k_black(Rgb(0.1f)), k_white(Rgb(0.9f, 0.8f, 0.05f));

TEST(Checkerboard, AlternatesTwiceInEachUnitSquare) {
  const auto board = make_checkerboard(k_black, k_white, {});
  const auto is_first = [&](float u, float v) { return board->eval({u, v}) == Rgb(0.1f); };
  for (const float shift : {-3.0f, 0.0f, 5.0f}) {
    EXPECT_TRUE(is_first(0.2f + shift, 0.3f));
    EXPECT_FALSE(is_first(0.7f + shift, 0.3f - shift));
    EXPECT_FALSE(is_first(0.2f, 0.7f + shift));
    EXPECT_TRUE(is_first(0.7f, 0.7f + shift));
  }
  EXPECT_FALSE(is_first(-0.2f, 0.3f));
  EXPECT_TRUE(is_first(-0.2f, -0.3f));
}

TEST(Checkerboard, TransformsUvs) {
  const auto board = make_checkerboard(k_black, k_white, {{4, 0}, {0, 2}, {0.5f, 0}});
  EXPECT_EQ(board->eval({0.01f, 0.1f}), k_white.eval({}));
  EXPECT_EQ(board->eval({0.126f, 0.1f}), k_black.eval({}));
  EXPECT_EQ(board->eval({0.126f, 0.26f}), k_white.eval({}));
}

TEST(Checkerboard, HasTheRangeOfBothColours) {
  const auto board = make_checkerboard(k_black, k_white, {});
  EXPECT_EQ(board->max_value(), Rgb(0.9f, 0.8f, 0.1f));
  EXPECT_EQ(board->min_value(), Rgb(0.1f, 0.1f, 0.05f));
}

TEST(Checkerboard, NestedTexturesSeeTheSurfacesUvs) {
  const auto ramp =
      make_bitmap(std::make_shared<const Texels>(Texels{{2, 1}, 1, std::vector<float>{0, 1}}), {.encoding = {1}});
  const auto board = make_checkerboard(Texture(ramp), k_white, {{8, 0}, {0, 8}, {}});
  EXPECT_EQ(board->eval({0.51f, 0.51f}), ramp->eval({0.51f, 0.51f}));
  EXPECT_EQ(board->gradient({0.51f, 0.51f}), ramp->gradient({0.51f, 0.51f}));
  EXPECT_EQ(board->gradient({0.51f, 0.6f}), Vec2());
}

TEST(Checkerboard, StandsAnyCoordinates) {
  const auto board = make_checkerboard(k_black, k_white, {});
  for (const float u : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")})
    EXPECT_TRUE(is_finite(board->eval({u, 0.2f})));
}

}  // namespace
}  // namespace gradslc
