#pragma once

#include <cstdint>

#include "core/bulk_vector.h"

namespace gradslc {

struct SortRecord {
  std::uint64_t key, value;
  bool operator==(const SortRecord&) const = default;
};

/// Sorts by key, stable: least significant digit first, eight passes of eight bits, chunks of fixed size in parallel.
/// Passes whose digit is the same everywhere are skipped.
void radix_sort(BulkVector<SortRecord>& records);

}  // namespace gradslc
