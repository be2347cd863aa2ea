#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace gradslc {

/// Memory for arrays of up to many gigabytes, aligned to a cache line. Large arrays lie on large pages where the system
/// has them, take up only what has been written to, and go back to the system when freed. Throws std::bad_alloc.
void* allocate_bulk(std::size_t bytes);
void free_bulk(void* memory) noexcept;

/// Leaves elements that are made without a value as the memory is: resizing is free, and pages are first touched by
/// the threads that fill them. Only for plain structs.
template <class T>
class BulkAllocator {
 public:
  using value_type = T;  // NOLINT(readability-identifier-naming): what allocators must call it
  BulkAllocator() = default;
  template <class U>
  BulkAllocator(const BulkAllocator<U>&) {}

  T* allocate(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T> && alignof(T) <= 64);
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_bulk(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { free_bulk(memory); }
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
  template <class U>
  bool operator==(const BulkAllocator<U>&) const {
    return true;
  }
};

/// A vector whose resize() leaves new elements uninitialised: all of them must be written before they are read.
template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

}  // namespace gradslc
