#include "reconstruction/blend.h"

#include <algorithm>
#include <cstddef>

#include "reconstruction/box_sums.h"

namespace gradslc {
namespace {

constexpr float k_trust = 0.1f;  // of the squares, as if they had said t = 1
constexpr double k_dark = 0.01;  // of the mean square, beside a pixel's own

/// Products of what lies between the images: sums give t.
struct Products {
  float wanted = 0, possible = 0;
  Products& operator+=(Products o) {
    wanted += o.wanted, possible += o.possible;
    return *this;
  }
};

float dot(Rgb a, Rgb b) { return a.r * b.r + a.g * b.g + a.b * b.b; }

Image<Products> products(const RgbImage& from, const RgbImage& towards, const RgbImage& judge) {
  double square_sum = 0;
  for (const Rgb& value : from) square_sum += static_cast<double>(dot(value, value));
  const auto dark = static_cast<float>(k_dark * square_sum / static_cast<double>(from.size()));
  Image<Products> found(from.resolution());
  for_each_row(from.resolution(), [&](int y) {
    for (int x = 0; x < from.width(); ++x) {
      const Rgb start = from(x, y), way = towards(x, y) - start;
      const float size = dot(towards(x, y), towards(x, y)) + dark;
      if (size > 0) found(x, y) = {dot(way, judge(x, y) - start) / size, dot(way, way) / size};
    }
  });
  return found;
}

}  // namespace

RgbImage blend(const RgbImage& from, const RgbImage& towards, const RgbImage& judge, int radius) {
  const Image<Products> sums = box_sums(products(from, towards, judge), radius);
  RgbImage blended(from.resolution());
  for (std::size_t i = 0; i < blended.size(); ++i) {
    const float possible = sums[i].possible;
    const float t = possible > 0 ? (sums[i].wanted + k_trust * possible) / (possible + k_trust * possible) : 1;
    blended[i] = from[i] + (towards[i] - from[i]) * std::clamp(t, 0.0f, 1.0f);
  }
  return blended;
}

}  // namespace gradslc
