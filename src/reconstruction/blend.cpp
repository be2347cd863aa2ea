#include "reconstruction/blend.h"

#include <algorithm>
#include <cstddef>

#include "core/parallel.h"

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

template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

float dot(Rgb a, Rgb b) { return a.r * b.r + a.g * b.g + a.b * b.b; }

Image<Products> products(const RgbImage& from, const RgbImage& towards, const RgbImage& judge) {
  double square_sum = 0;
  for (const Rgb& value : from) square_sum += static_cast<double>(dot(value, value));
  const auto dark = static_cast<float>(k_dark * square_sum / static_cast<double>(from.size()));
  Image<Products> found(from.resolution());
  for_each_row(from.height(), [&](int y) {
    for (int x = 0; x < from.width(); ++x) {
      const Rgb start = from(x, y), way = towards(x, y) - start;
      const float size = dot(towards(x, y), towards(x, y)) + dark;
      if (size > 0) found(x, y) = {dot(way, judge(x, y) - start) / size, dot(way, way) / size};
    }
  });
  return found;
}

Image<Products> box_sums(const Image<Products>& values, int radius) {
  const int width = values.width(), height = values.height();
  Image<Products> rows(values.resolution()), boxes(values.resolution());
  for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x)
      for (int i = std::max(0, x - radius); i <= std::min(width - 1, x + radius); ++i) rows(x, y) += values(i, y);
  });
  for_each_row(height, [&](int y) {
    for (int j = std::max(0, y - radius); j <= std::min(height - 1, y + radius); ++j)
      for (int x = 0; x < width; ++x) boxes(x, y) += rows(x, j);
  });
  return boxes;
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
