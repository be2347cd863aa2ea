#pragma once

#include <algorithm>
#include <cstddef>

#include "core/image.h"
#include "core/parallel.h"

namespace gradslc {

/// Rows that a thread takes at a time.
inline std::size_t rows_per_chunk(Resolution resolution) {
  constexpr std::size_t k_pixels_per_chunk = 16384;
  return std::max<std::size_t>(1, k_pixels_per_chunk / static_cast<std::size_t>(std::max(1, resolution.width)));
}

/// Calls body(y) for all rows on all threads, or at once where there is little to do.
template <class Body>
void for_each_row(Resolution resolution, const Body& body) {
  const auto rows = static_cast<std::size_t>(resolution.height), per_chunk = rows_per_chunk(resolution);
  const auto some_rows = [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  };
  if (rows <= per_chunk)
    some_rows(0, rows);
  else
    parallel_for(rows, per_chunk, some_rows);
}

}  // namespace gradslc
