#include "lighttree/builders/morton_order.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>

#include "core/bounds.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr std::size_t k_grain = 1 << 15;

/// Spreads 21 bits to every third position.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// A sum of boxes is the box that holds them.
struct BoxSum {
  Bounds3 box;
  BoxSum& operator+=(const BoxSum& o) {
    box.extend(o.box);
    return *this;
  }
};

}  // namespace

MortonCode::MortonCode(const Bounds3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    lower_[axis] = static_cast<double>(box.lower[axis]);
    const double extent = static_cast<double>(box.upper[axis]) - lower_[axis];
    if (extent > 0) cells_per_length_[axis] = 0x1p21 / extent;
  }
}

std::uint64_t MortonCode::operator()(Point3 p) const {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (static_cast<double>(p[axis]) - lower_[axis]) * cells_per_length_[axis];
    code |= spread_bits(static_cast<std::uint64_t>(std::clamp(cell, 0.0, 0x1p21 - 1))) << axis;
  }
  return code;
}

Bounds3 box_of(std::span<const Vpl> vpls) {
  return parallel_sum<BoxSum>(vpls.size(), k_grain,
                              [&](std::size_t begin, std::size_t end) {
                                BoxSum sum;
                                for (std::size_t i = begin; i < end; ++i) sum.box.extend(vpls[i].position);
                                return sum;
                              })
      .box;
}

void sort_in_morton_order(std::span<Vpl> vpls, std::span<std::byte> scratch) {
  const std::size_t count = vpls.size();
  assert(scratch.size() >= count * k_morton_bytes);
  // Records first; behind them their copy while they are sorted, the sorted VPLs afterwards.
  const std::span records(reinterpret_cast<SortRecord*>(scratch.data()), count);
  std::byte* const behind = scratch.data() + records.size_bytes();
  const MortonCode code(box_of(vpls));
  parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) records[i] = {code(vpls[i].position), i};
  });
  radix_sort(records, {reinterpret_cast<SortRecord*>(behind), count});
  constexpr std::size_t k_ahead = 24;  // enough reads under way to hide the memory's latency
  const std::span sorted(reinterpret_cast<Vpl*>(behind), count);
  parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i + k_ahead < end) __builtin_prefetch(&vpls[records[i + k_ahead].value]);
      sorted[i] = vpls[records[i].value];
    }
  });
  parallel_for(count, k_grain, [&](std::size_t begin, std::size_t end) {
    std::memcpy(&vpls[begin], &sorted[begin], (end - begin) * sizeof(Vpl));
  });
}

}  // namespace gradslc
