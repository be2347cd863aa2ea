#include "core/parallel.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>

namespace gradslc {

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t chunks = (count + grain - 1) / grain;
  std::exception_ptr error;
  std::mutex error_mutex;
  std::atomic<std::size_t> error_chunk = std::numeric_limits<std::size_t>::max();  // the first one that has thrown
#pragma omp parallel for schedule(dynamic, 1) if (chunks > 1)
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    if (chunk > error_chunk.load(std::memory_order_relaxed)) continue;
    try {
      body(chunk * grain, std::min(count, (chunk + 1) * grain));
    } catch (...) {
      const std::lock_guard lock(error_mutex);
      if (chunk < error_chunk) error = std::current_exception(), error_chunk = chunk;
    }
  }
  if (error) std::rethrow_exception(error);
}

void set_thread_count(int threads) { omp_set_num_threads(threads > 0 ? threads : omp_get_num_procs()); }

int thread_count() { return omp_get_max_threads(); }

}  // namespace gradslc
