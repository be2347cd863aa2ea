#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/bounds.h"
#include "core/radix_sort.h"
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

/// Sorts VPLs by the Morton codes of their positions within their common box; equal ones keep their order. `scratch` is
/// aligned to 16 bytes, has k_morton_bytes for each VPL, and is overwritten: memory that is needed later anyway can be
/// lent, since fresh pages cost more time than the sort.
void sort_in_morton_order(std::span<Vpl> vpls, std::span<std::byte> scratch);
constexpr std::size_t k_morton_bytes = sizeof(SortRecord) + sizeof(Vpl);

}  // namespace gradslc
