#pragma once

#include <algorithm>

#include "reconstruction/rows.h"

namespace gradslc {

/// Sums over boxes of (2 radius + 1)^2 pixels, less at the border. Summed anew for each pixel: a running sum would keep
/// the rounding error of the largest value that it has passed. `T` needs a zero default value and +=.
template <class T>
Image<T> box_sums(const Image<T>& values, int radius) {
  const int width = values.width(), height = values.height();
  Image<T> rows(values.resolution()), boxes(values.resolution());
  for_each_row(values.resolution(), [&](int y) {
    for (int x = 0; x < width; ++x)
      for (int i = std::max(0, x - radius); i <= std::min(width - 1, x + radius); ++i) rows(x, y) += values(i, y);
  });
  for_each_row(values.resolution(), [&](int y) {
    for (int j = std::max(0, y - radius); j <= std::min(height - 1, y + radius); ++j)
      for (int x = 0; x < width; ++x) boxes(x, y) += rows(x, j);
  });
  return boxes;
}

}  // namespace gradslc
