#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace gradslc {

/// Calls body(begin, end) for chunks of at most `grain` indices that cover [0, count), on all threads, in any order.
/// The chunks do not depend on the number of threads. The exception of the first chunk that throws is rethrown after
/// the loop; chunks after it are not begun any more, those before it are, so that it is the same one every time.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Sum of chunk_sum(begin, end) over the same chunks, added in their order: the same bits for any number of threads.
/// `T` needs a zero default value and +=.
template <class T, class ChunkSum>
T parallel_sum(std::size_t count, std::size_t grain, const ChunkSum& chunk_sum) {
  std::vector<T> partial((count + grain - 1) / grain);
  parallel_for(count, grain,
               [&](std::size_t begin, std::size_t end) { partial[begin / grain] = chunk_sum(begin, end); });
  T total{};
  for (const T& part : partial) total += part;
  return total;
}

/// Sets how many threads parallel_for uses from now on in this process; 0 = one per core.
void set_thread_count(int threads);
int thread_count();

}  // namespace gradslc
