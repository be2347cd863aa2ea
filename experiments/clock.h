#pragma once

#include <functional>

namespace gradslc {

/// Seconds on the wall and of all the process's threads together; of a moment or of a span.
struct Seconds {
  double wall = 0, cpu = 0;
  constexpr Seconds& operator+=(Seconds o) { return *this = {wall + o.wall, cpu + o.cpu}; }
};
constexpr Seconds operator+(Seconds a, Seconds b) { return a += b; }
constexpr Seconds operator-(Seconds a, Seconds b) { return {a.wall - b.wall, a.cpu - b.cpu}; }

/// Tells the time since some fixed moment. An argument wherever time is measured, so that tests can set it.
using Clock = std::function<Seconds()>;

/// Wall time that never jumps (steady_clock) and CPU time of the process (CLOCK_PROCESS_CPUTIME_ID).
Seconds system_time();

/// Runs `work` and returns the time that it took.
template <class Work>
Seconds measure(const Clock& clock, const Work& work) {
  const Seconds begin = clock();
  work();
  return clock() - begin;
}

}  // namespace gradslc
