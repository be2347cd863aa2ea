#include "core/radix_sort.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr std::size_t k_digits = 256;
using Histogram = std::array<std::size_t, k_digits>;

/// Turns counts per chunk and digit into the first position of each; false if one digit holds all records.
bool scan(std::vector<Histogram>& histograms, std::size_t count) {
  std::size_t position = 0;
  for (std::size_t digit = 0; digit < k_digits; ++digit) {
    const std::size_t digit_begin = position;
    for (Histogram& histogram : histograms) {
      const std::size_t n = histogram[digit];
      histogram[digit] = position;
      position += n;
    }
    if (position - digit_begin == count) return false;
  }
  return true;
}

}  // namespace

void radix_sort(std::span<SortRecord> records, std::span<SortRecord> scratch) {
  assert(scratch.size() == records.size());
  constexpr std::size_t k_grain = std::size_t{1} << 16;
  const std::size_t count = records.size();
  if (count < 2) return;
  std::span<SortRecord> from = records, to = scratch;
  std::vector<Histogram> histograms((count + k_grain - 1) / k_grain);
  for (unsigned shift = 0; shift < 64; shift += 8) {
    parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
      Histogram histogram{};
      for (std::size_t i = begin; i < end; ++i) ++histogram[from[i].key >> shift & 0xff];
      histograms[begin / k_grain] = histogram;
    });
    if (!scan(histograms, count)) continue;
    parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
      Histogram& position = histograms[begin / k_grain];
      for (std::size_t i = begin; i < end; ++i) to[position[from[i].key >> shift & 0xff]++] = from[i];
    });
    std::swap(from, to);
  }
  if (from.data() == records.data()) return;
  parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin), from.begin() + static_cast<std::ptrdiff_t>(end),
              records.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

}  // namespace gradslc
