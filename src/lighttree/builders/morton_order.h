#pragma once

#include <cstdint>
#include <span>

#include "core/bounds.h"
#include "vpl/vpl.h"

namespace gradslc {

/// Maps points of a box to 63-bit Morton codes: the bits of 2^21 cells along each axis, interleaved. Axes without
/// extent give 0.
class MortonCode {
 public:
  explicit MortonCode(const Bounds3& box);
  std::uint64_t operator()(Point3 p) const;

 private:
  double lower_[3], cells_per_length_[3] = {0, 0, 0};
};

/// The box of VPLs' positions, on all threads.
Bounds3 box_of(std::span<const Vpl> vpls);

/// Sorts VPLs by the Morton codes of their positions within their common box; equal ones keep their order. Returns
/// them. At its peak needs k_morton_bytes more for a VPL.
std::span<Vpl> sort_in_morton_order(BulkVector<Vpl>& vpls);
constexpr double k_morton_bytes = sizeof(Vpl) + 16;

}  // namespace gradslc
