#include "core/bulk_vector.h"

#include <sys/mman.h>

#include <cstdlib>

namespace gradslc {
namespace {

constexpr std::size_t k_cache_line = 64, k_large_page = std::size_t{2} << 20;

}  // namespace

void* allocate_bulk(std::size_t bytes) {
  const bool large = bytes >= 2 * k_large_page;
  const std::size_t alignment = large ? k_large_page : k_cache_line;
  if (bytes > std::numeric_limits<std::size_t>::max() - alignment) throw std::bad_alloc();
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded);
  if (!memory) throw std::bad_alloc();
  if (large) madvise(memory, rounded, MADV_HUGEPAGE);  // advice: the system may ignore it
  return memory;
}

void free_bulk(void* memory) noexcept { std::free(memory); }

}  // namespace gradslc
