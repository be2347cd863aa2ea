#pragma once

#include "vpl/vpl.h"

namespace gradslc {

/// Sorts VPLs by the 63-bit Morton codes of their positions within their common box; equal ones keep their order. At
/// its peak needs k_morton_bytes more for a VPL.
void sort_in_morton_order(BulkVector<Vpl>& vpls);
constexpr std::uint64_t k_morton_bytes = sizeof(Vpl) + 16;

}  // namespace gradslc
