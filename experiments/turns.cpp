#include "experiments/turns.h"

namespace gradslc {
namespace {

constexpr double k_slice = 1.0 / 50;  // of the budget

/// Index of the run that goes on; runs.size() when all are done.
std::size_t next_run(std::span<MethodRun> runs, std::size_t first) {
  std::size_t next = runs.size();
  for (std::size_t offset = 0; offset < runs.size(); ++offset) {
    const std::size_t i = (first + offset) % runs.size();
    if (runs[i].done()) continue;
    if (next == runs.size() || runs[i].progress() < runs[next].progress()) next = i;
  }
  return next;
}

double mean_progress(std::span<MethodRun> runs) {
  double sum = 0;
  for (const MethodRun& run : runs) sum += run.progress();
  return sum / static_cast<double>(runs.size());
}

}  // namespace

void take_turns(std::span<MethodRun> runs, std::size_t first, const PointReceiver& receive,
                const std::function<void(double)>& progress) {
  for (std::size_t i = next_run(runs, first); i < runs.size(); i = next_run(runs, first)) {
    MethodRun& run = runs[i];
    const double end = run.progress() + k_slice;
    do {
      for (PointImage& point : run.step()) receive(i, std::move(point));
    } while (!run.done() && run.progress() < end);
    progress(mean_progress(runs));
  }
}

}  // namespace gradslc
