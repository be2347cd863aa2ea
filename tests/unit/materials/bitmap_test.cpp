#include "materials/bitmap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>

#include "materials/scaled_texture.h"

namespace gradslc {
namespace {

constexpr Wrap k_wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::zero, Wrap::one};
constexpr Encoding k_linear{1};

template <class Value>
std::shared_ptr<const Texels> texels(Resolution resolution, int channels, std::vector<Value> values) {
  EXPECT_EQ(values.size(), resolution.pixels() * static_cast<std::size_t>(channels));
  return std::make_shared<const Texels>(Texels{resolution, channels, std::move(values)});
}

/// A row of floats 2, 3, 4, 5: no wrap's own value is among them.
std::shared_ptr<const TextureMap> row(Wrap wrap, bool nearest) {
  return make_bitmap(texels<float>({4, 1}, 1, {2, 3, 4, 5}),
                     {.wrap_u = wrap, .nearest = nearest, .encoding = k_linear});
}

TEST(Bitmap, IsTheTexelAtItsCentreAndRunsDownwards) {
  const auto bitmap = make_bitmap(texels<std::uint8_t>({2, 2}, 1, {10, 60, 110, 210}), {});
  const auto decoded = [](int code) { return Rgb(srgb_to_linear(static_cast<float>(code) / 255)); };
  EXPECT_EQ(bitmap->eval({0.25f, 0.25f}), decoded(10));
  EXPECT_EQ(bitmap->eval({0.75f, 0.25f}), decoded(60));
  EXPECT_EQ(bitmap->eval({0.25f, 0.75f}), decoded(110));
  EXPECT_EQ(bitmap->eval({0.75f, 0.75f}), decoded(210));
  const float mean = (decoded(10).r + decoded(60).r + decoded(110).r + decoded(210).r) / 4;
  EXPECT_NEAR(bitmap->eval({0.5f, 0.5f}).g, mean, 1e-6f) << "linear values are interpolated, not codes";
}

TEST(Bitmap, DecodesEveryCodeExactly) {
  std::vector<std::uint8_t> codes(256);
  std::iota(codes.begin(), codes.end(), std::uint8_t{0});
  const auto image = texels<std::uint8_t>({256, 1}, 1, codes);
  const auto srgb = make_bitmap(image, {.nearest = true});
  const auto raw = make_bitmap(image, {.nearest = true, .encoding = k_linear});
  const auto power = make_bitmap(image, {.nearest = true, .encoding = {2.2f}});
  for (int i = 0; i < 256; ++i) {
    const Vec2 uv{(static_cast<float>(i) + 0.5f) / 256, 0.5f};
    const float stored = static_cast<float>(i) / 255;
    EXPECT_EQ(srgb->eval(uv).r, srgb_to_linear(stored));
    EXPECT_EQ(raw->eval(uv).r, stored);
    EXPECT_FLOAT_EQ(power->eval(uv).r, std::pow(stored, 2.2f));
  }
}

TEST(Bitmap, Decodes16Bits) {
  const auto bitmap = make_bitmap(texels<std::uint16_t>({2, 1}, 3, {0, 1000, 30000, 65535, 40000, 7}), {});
  EXPECT_EQ(bitmap->eval({0.25f, 0.5f}), Rgb(0, srgb_to_linear(1000 / 65535.0f), srgb_to_linear(30000 / 65535.0f)));
  EXPECT_EQ(bitmap->max_value(), Rgb(1, srgb_to_linear(40000 / 65535.0f), srgb_to_linear(30000 / 65535.0f)));
}

TEST(Bitmap, ChoosesChannels) {
  const auto image = texels<std::uint8_t>({1, 1}, 4, {51, 102, 153, 204});
  const auto value = [&](int channel) {
    return make_bitmap(image, {.encoding = k_linear, .channel = channel})->eval({0.5f, 0.5f});
  };
  EXPECT_EQ(value(-1), Rgb(0.2f, 0.4f, 0.6f)) << "alpha is left out";
  EXPECT_EQ(value(1), Rgb(0.4f));
  EXPECT_EQ(value(3), Rgb(0.8f));
  const auto grey = texels<std::uint8_t>({1, 1}, 2, {51, 102});
  EXPECT_EQ(make_bitmap(grey, {.encoding = k_linear})->eval({0, 0}), Rgb(0.2f));
}

TEST(Bitmap, WrapsTheNearestTexel) {
  struct Case {
    Wrap wrap;
    float u, value;
  };
  const Case cases[] = {
      {Wrap::repeat, 0, 2},     {Wrap::repeat, 0.99f, 5}, {Wrap::repeat, 1, 2},        {Wrap::repeat, 1.3f, 3},
      {Wrap::repeat, -0.1f, 5}, {Wrap::repeat, -0.3f, 4}, {Wrap::repeat, -7.9f, 2},    {Wrap::repeat, 1000.6f, 4},
      {Wrap::mirror, -0.1f, 2}, {Wrap::mirror, -0.3f, 3}, {Wrap::mirror, 1.1f, 5},     {Wrap::mirror, 1.9f, 2},
      {Wrap::mirror, 2.3f, 3},  {Wrap::mirror, -1.1f, 5}, {Wrap::mirror, -1000.3f, 3}, {Wrap::clamp, -0.1f, 2},
      {Wrap::clamp, -50, 2},    {Wrap::clamp, 1, 5},      {Wrap::clamp, 50, 5},        {Wrap::zero, 0.1f, 2},
      {Wrap::zero, -0.01f, 0},  {Wrap::zero, 1, 0},       {Wrap::zero, 1e20f, 0},      {Wrap::one, 0.9f, 5},
      {Wrap::one, 1.01f, 1},    {Wrap::one, -1e20f, 1},
  };
  for (const Case& c : cases)
    EXPECT_EQ(row(c.wrap, true)->eval({c.u, 0.5f}).r, c.value) << "wrap " << static_cast<int>(c.wrap) << " u " << c.u;
}

TEST(Bitmap, InterpolatesAcrossTheBorder) {
  const auto left = [](Wrap wrap) { return row(wrap, false)->eval({0, 0.5f}).r; };
  EXPECT_FLOAT_EQ(left(Wrap::repeat), 3.5f);
  EXPECT_FLOAT_EQ(left(Wrap::mirror), 2);
  EXPECT_FLOAT_EQ(left(Wrap::clamp), 2);
  const auto right = [](Wrap wrap) { return row(wrap, false)->eval({1 + 1 / 16.0f, 0.5f}).r; };
  EXPECT_FLOAT_EQ(right(Wrap::repeat), 0.25f * 5 + 0.75f * 2);
  EXPECT_FLOAT_EQ(right(Wrap::mirror), 5);
  EXPECT_FLOAT_EQ(right(Wrap::clamp), 5);
  // Along v every row of zero and one blends with what is outside; the middle of a single texel does not.
  EXPECT_FLOAT_EQ(left(Wrap::zero), 1);
  EXPECT_FLOAT_EQ(left(Wrap::one), 1.5f);
  EXPECT_FLOAT_EQ(right(Wrap::zero), 0.25f * 5);
  EXPECT_FLOAT_EQ(right(Wrap::one), 0.25f * 5 + 0.75f);
}

TEST(Bitmap, WrapsEachAxisInItsOwnWay) {
  const auto bitmap = make_bitmap(texels<float>({2, 2}, 1, {2, 3, 4, 5}),
                                  {.wrap_u = Wrap::clamp, .wrap_v = Wrap::one, .nearest = true, .encoding = k_linear});
  EXPECT_EQ(bitmap->eval({7, 0.75f}).r, 5);
  EXPECT_EQ(bitmap->eval({0.25f, 1.5f}).r, 1);
  EXPECT_EQ(bitmap->eval({0.25f, -0.1f}).r, 1);
}

TEST(Bitmap, StandsAnyCoordinates) {
  constexpr float k_infinite = std::numeric_limits<float>::infinity();
  constexpr float k_extreme[] = {
      1e30f,       -1e30f,      3e38f, -3e38f, 2147483648.0f, -4294967296.0f, 16777217.0f, -1e-9f,
      -1.0000001f, 0.99999994f, 1,     -1,     1e-40f,        k_infinite,     -k_infinite, std::nanf("")};
  for (const Wrap wrap : k_wraps)
    for (const bool nearest : {false, true}) {
      const auto bitmap = make_bitmap(texels<float>({3, 2}, 1, {2, 3, 4, 5, 6, 7}),
                                      {.wrap_u = wrap, .wrap_v = wrap, .nearest = nearest, .encoding = k_linear});
      for (const float u : k_extreme)
        for (const float v : k_extreme) {
          const float value = bitmap->eval({u, v}).r;
          EXPECT_TRUE(value >= bitmap->min_value().r && value <= bitmap->max_value().r) << u << " " << v;
          const Vec2 slope = bitmap->gradient({u, v});
          EXPECT_TRUE(std::isfinite(slope.x) && std::isfinite(slope.y)) << u << " " << v;
        }
    }
}

TEST(Bitmap, TransformsUvs) {
  const UvTransform to_uv{{0.5f, 0}, {0, 0.25f}, {0.125f, 0.5f}};
  const auto bitmap = make_bitmap(texels<float>({4, 4}, 1, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}),
                                  {.to_uv = to_uv, .encoding = k_linear});
  EXPECT_EQ(bitmap->eval({0.5f, 0.5f}).r, 9) << "texel (1,2), centre (0.375, 0.625)";
}

TEST(Bitmap, GradientIsTheDerivativeOfTheLuminance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> values(5 * 4 * 3);
  for (float& value : values) value = uniform(random);
  const auto image = texels<float>({5, 4}, 3, values);
  const UvTransform to_uv{{1.5f, 0.5f}, {-0.25f, 0.75f}, {0.1f, -0.3f}};
  for (const Wrap wrap : k_wraps) {
    const auto bitmap = make_bitmap(image, {.to_uv = to_uv, .wrap_u = wrap, .wrap_v = wrap, .encoding = k_linear});
    const auto luminance_at = [&](float u, float v) { return luminance(bitmap->eval({u, v})); };
    int compared = 0;
    for (int i = 0; i < 400; ++i) {
      const float u = 4 * uniform(random) - 2, v = 4 * uniform(random) - 2, h = 1e-3f;
      const auto cell = [&](float du, float dv) {
        const auto [x, y] = to_uv.apply({u + du, v + dv});
        return std::pair(std::floor(x * 10), std::floor(y * 8));  // half texels: kinks are between some
      };
      if (cell(h, 0) != cell(-h, 0) || cell(0, h) != cell(0, -h) || cell(h, 0) != cell(0, h)) continue;
      const Vec2 slope = bitmap->gradient({u, v});
      EXPECT_NEAR(slope.x, (luminance_at(u + h, v) - luminance_at(u - h, v)) / (2 * h), 2e-3f);
      EXPECT_NEAR(slope.y, (luminance_at(u, v + h) - luminance_at(u, v - h)) / (2 * h), 2e-3f);
      ++compared;
    }
    EXPECT_GT(compared, 300);
  }
}

TEST(Bitmap, HasNoSlopeWhereItIsNotInterpolated) { EXPECT_EQ(row(Wrap::repeat, true)->gradient({0.5f, 0.5f}), Vec2()); }

TEST(Bitmap, RangeHoldsWhatLiesOutsideToo) {
  const auto range = [](Wrap wrap) { return std::pair(row(wrap, false)->min_value(), row(wrap, false)->max_value()); };
  EXPECT_EQ(range(Wrap::repeat), std::pair(Rgb(2), Rgb(5)));
  EXPECT_EQ(range(Wrap::zero), std::pair(Rgb(0), Rgb(5)));
  EXPECT_EQ(range(Wrap::one), std::pair(Rgb(1), Rgb(5)));
}

TEST(Bitmap, NeverLeavesItsRange) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<std::uint8_t> values(7 * 3 * 3);
  for (auto& value : values) value = static_cast<std::uint8_t>(random() % 2 == 0 ? 40 : 255);
  const auto bitmap = make_bitmap(texels<std::uint8_t>({7, 3}, 3, values), {});
  const Rgb low = bitmap->min_value(), high = bitmap->max_value();
  for (int i = 0; i < 100000; ++i) {
    const Rgb value = bitmap->eval({uniform(random), uniform(random)});
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(value[c] >= low[c] && value[c] <= high[c]);
  }
}

TEST(Bitmap, CountsItsMemory) {
  const std::vector<std::uint8_t> values(3 * 100 * 50);
  EXPECT_EQ(make_bitmap(texels<std::uint8_t>({100, 50}, 3, values), {})->memory_bytes(), 15000u + 256 * sizeof(float));
}

TEST(ScaledTexture, ScalesValuesSlopesAndRange) {
  const Texture bitmap(row(Wrap::repeat, false));
  const Texture scaled = scale_texture(bitmap, Rgb(2, -1, 0.5f));
  EXPECT_EQ(scaled.eval({0.375f, 0.5f}), Rgb(6, -3, 1.5f));
  EXPECT_EQ(scaled.max_value(), Rgb(10, -2, 2.5f));
  EXPECT_EQ(scaled.min_value(), Rgb(4, -5, 1));
  EXPECT_EQ(scale_texture(bitmap, Rgb(3)).gradient({0.5f, 0.5f}), Vec2(3 * bitmap.gradient({0.5f, 0.5f})));
  EXPECT_EQ(scale_texture(Texture(Rgb(2)), Rgb(3)).map(), nullptr) << "a constant stays one";
  EXPECT_EQ(scale_texture(Texture(Rgb(2)), Rgb(3)).eval({}), Rgb(6));
}

}  // namespace
}  // namespace gradslc
