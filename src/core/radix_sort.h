#pragma once

#include <cstdint>

#include <span>

namespace gradslc {

struct SortRecord {
  std::uint64_t key, value;
  bool operator==(const SortRecord&) const = default;
};

/// Sorts by key, stable: least significant digit first, eight passes of eight bits, chunks of fixed size in parallel.
/// Passes whose digit is the same everywhere are skipped.
/// `scratch` is as long as `records` and is overwritten.
void radix_sort(std::span<SortRecord> records, std::span<SortRecord> scratch);

}  // namespace gradslc
