// Time of building a light tree, by number of VPLs; sorting keys alone beside it, which a builder is measured by.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/sort/spreadsort/integer_sort.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/radix_sort.h"
#include "lighttree/light_tree.h"

namespace gradslc {
namespace {

/// In [0, 1).
float random_unit(std::uint64_t index, std::uint64_t use) {
  return to_unit_float(static_cast<std::uint32_t>(hash_combine(use, index)));
}

/// On a wall of a box of 1 x 2 x 3, denser towards some point of the wall; one in sixteen is glossy.
Vpl make_vpl(std::uint64_t index, VplSet& set) {
  const auto wall = static_cast<int>(6 * random_unit(index, 1));
  const int axis = wall / 2;
  const float extent[3] = {1, 2, 3};
  float position[3], normal[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const float dense = random_unit(static_cast<std::uint64_t>(wall), 2 + static_cast<std::uint64_t>(i));
    const float offset = random_unit(index, 5 + static_cast<std::uint64_t>(i)) - dense;
    position[i] = extent[i] * (random_unit(index, 8) < 0.5f ? dense + offset * offset * offset : dense + offset);
  }
  position[axis] = wall % 2 == 0 ? 0 : extent[axis];
  normal[axis] = wall % 2 == 0 ? 1 : -1;
  Vpl vpl;
  vpl.position = {position[0], position[1], position[2]};
  vpl.flux = Rgb(0.5f + random_unit(index, 9));
  vpl.max_pi_f = 0.5f;
  vpl.geometric_normal = vpl.shading_normal = OctahedralNormal({normal[0], normal[1], normal[2]});
  vpl.incoming = vpl.geometric_normal;
  vpl.vertex = 1;
  if (random_unit(index, 10) < 1.0f / 16) {
    vpl.surface = static_cast<std::uint32_t>(set.surfaces.size());
    set.surfaces.push_back({.material = 0,
                            .uv = {},
                            .tangent = vpl.geometric_normal,
                            .bound = {.broad = 0.3f, .gloss = {.peak = 5, .tail = 5, .alpha2 = 0.01f}},
                            .behind = false,
                            .transmits = false});
  }
  return vpl;
}

VplSet make_set(std::int64_t count, bool glossy) {
  VplSet set;
  for (std::int64_t i = 0; i < count; ++i) set.vpls.push_back(make_vpl(static_cast<std::uint64_t>(i), set));
  if (glossy) return set;
  set.surfaces.clear();
  for (Vpl& vpl : set.vpls) vpl.surface = Vpl::k_lambert;
  return set;
}

/// Largest resident memory of this process so far, in bytes; pages come back to the system between benchmarks.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void sort_keys(benchmark::State& state, const std::function<void(BulkVector<SortRecord>&)>& sort) {
  const int threads_before = thread_count();
  set_thread_count(static_cast<int>(state.range(1)));
  const auto count = static_cast<std::size_t>(state.range(0));
  for ([[maybe_unused]] auto iteration : state) {
    state.PauseTiming();
    BulkVector<SortRecord> records(count);
    for (std::size_t i = 0; i < count; ++i) records[i] = {mix64(i) >> 1, i};
    state.ResumeTiming();
    sort(records);
    benchmark::DoNotOptimize(records[0]);
  }
  set_thread_count(threads_before);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

bool before(const SortRecord& a, const SortRecord& b) { return a.key < b.key; }

void sort_radix(benchmark::State& state) {
  sort_keys(state, [](BulkVector<SortRecord>& records) {
    BulkVector<SortRecord> scratch(records.size());
    radix_sort(records, scratch);
  });
}
void sort_spread(benchmark::State& state) {
  sort_keys(state, [](BulkVector<SortRecord>& records) {
    boost::sort::spreadsort::integer_sort(
        records.begin(), records.end(), [](const SortRecord& r, unsigned shift) { return r.key >> shift; }, before);
  });
}
void sort_standard(benchmark::State& state) {
  sort_keys(state, [](BulkVector<SortRecord>& records) { std::sort(records.begin(), records.end(), before); });
}

void build(benchmark::State& state, const char* builder, bool glossy) {
  const int threads_before = thread_count();
  const VplSet original = make_set(state.range(0), glossy);
  set_thread_count(static_cast<int>(state.range(1)));
  const auto registry = builder_registry();
  const auto entry = std::find_if(registry.begin(), registry.end(),
                                  [&](const BuilderEntry& e) { return std::string_view(e.name) == builder; });
  double nodes = 0;
  for ([[maybe_unused]] auto iteration : state) {
    state.PauseTiming();
    VplSet set = original;
    state.ResumeTiming();
    LightTree tree = entry->build(std::move(set));
    benchmark::DoNotOptimize(tree.nodes[0]);
    state.PauseTiming();
    nodes = static_cast<double>(tree.nodes.size());
    tree = LightTree();
    state.ResumeTiming();
  }
  set_thread_count(threads_before);
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["nodes"] = nodes;
  state.counters["peak_bytes"] = peak_bytes();
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"count", "threads"})->Args({10'000'000, 1})->Args({10'000'000, 2});
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
void tree_sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"count", "threads"})->Args({5'000, 1})->Args({5'000, 2});
  sizes(benchmark);
}
BENCHMARK(sort_radix)->Apply(sizes);
BENCHMARK(sort_spread)->ArgNames({"count", "threads"})->Args({10'000'000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(sort_standard)->ArgNames({"count", "threads"})->Args({10'000'000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, pairs, "pairs", false)->Apply(tree_sizes);
BENCHMARK_CAPTURE(build, saoh, "saoh", false)->Apply(tree_sizes);
BENCHMARK_CAPTURE(build, pairs_glossy, "pairs", true)->Apply(sizes);

}  // namespace
}  // namespace gradslc
