// Time of a reconstruction, by image size, and of plain conjugate gradients to compare it with; items are pixels.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "core/hash.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// In [-1, 1), from the pixel and what it is for.
float noise(std::uint64_t use, std::size_t pixel) {
  return 2 * to_unit_float(static_cast<std::uint32_t>(hash_combine(use, pixel))) - 1;
}

/// Differs from pixel to pixel by a factor of 100, as measured variances do.
float variance(std::uint64_t use, std::size_t pixel, float mean) { return mean * std::pow(10.0f, noise(use, pixel)); }

/// A half of 16 passes: smooth shading with edges, gradients ten times less noisy than the primal.
ReconstructionBuffers make_half(Resolution resolution, std::uint64_t seed) {
  ReconstructionBuffers half{RgbImage(resolution),         RgbImage(resolution),         RgbImage(resolution),
                             Image<float>(resolution, 16), Image<float>(resolution, 12), Image<float>(resolution, 12),
                             RgbImage(resolution),         RgbImage(resolution),         RgbImage(resolution)};
  const auto shading = [](int x, int y) {
    return 1 + 0.3f * std::sin(0.01f * static_cast<float>(x + 2 * y)) + static_cast<float>((x / 97 + y / 61) % 2);
  };
  for (int y = 0; y < resolution.height; ++y)
    for (int x = 0; x < resolution.width; ++x) {
      const std::size_t i = resolution.index({x, y});
      half.primal_variance[i] = Rgb(variance(seed + 3, i, 1e-2f));
      half.dx_variance[i] = Rgb(variance(seed + 4, i, 1e-4f));
      half.dy_variance[i] = Rgb(variance(seed + 5, i, 1e-4f));
      const auto sample = [&](float value, std::uint64_t use, Rgb of) {
        return Rgb(value + noise(use, i) * std::sqrt(of.r));
      };
      half.primal[i] = sample(shading(x, y), seed, half.primal_variance[i]);
      half.dx[i] = sample(shading(x + 1, y) - shading(x, y), seed + 1, half.dx_variance[i]);
      half.dy[i] = sample(shading(x, y + 1) - shading(x, y), seed + 2, half.dy_variance[i]);
    }
  return half;
}

FeatureBuffers make_features(Resolution resolution) {
  FeatureBuffers features{RgbImage(resolution), RgbImage(resolution), Image<float>(resolution, 1),
                          RgbImage(resolution), RgbImage(resolution), Image<float>(resolution, 1e-6f)};
  for (std::size_t i = 0; i < features.albedo.size(); ++i) {
    const Pixel pixel = resolution.pixel(i);
    features.albedo[i] = Rgb(0.3f + 0.4f * static_cast<float>((pixel.x / 97 + pixel.y / 61) % 2));
    features.normal[i] = Rgb(0, 0, 1);
  }
  return features;
}

void report(benchmark::State& state, Resolution resolution, const ReconstructionStatistics& statistics) {
  state.counters["iterations"] = statistics.iterations;
  state.counters["residual"] = statistics.relative_residual;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(resolution.pixels()));
}

void reconstruct(benchmark::State& state, const std::string& name) {
  const Resolution resolution{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const ReconstructionInput input{
      {make_half(resolution, 10), make_half(resolution, 20)}, make_half(resolution, 30), make_features(resolution)};
  for (const ReconstructionEntry& entry : reconstruction_registry()) {
    if (entry.name != name) continue;
    const std::unique_ptr<Reconstruction> method = entry.make();
    ReconstructionStatistics statistics;
    for ([[maybe_unused]] auto iteration : state) {
      ReconstructionResult result = method->reconstruct(input);
      benchmark::DoNotOptimize(result.image[0]);
      statistics = result.statistics;
    }
    report(state, resolution, statistics);
  }
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"width", "height"})->Args({160, 160})->Args({640, 360})->Args({1920, 1080});
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK_CAPTURE(reconstruct, l2, "l2")->Apply(sizes);
BENCHMARK_CAPTURE(reconstruct, l1, "l1")->Apply(sizes);
BENCHMARK_CAPTURE(reconstruct, weighted, "weighted")->Apply(sizes);
BENCHMARK_CAPTURE(reconstruct, feature, "feature")->Apply(sizes);
BENCHMARK_CAPTURE(reconstruct, denoise, "denoise")->Apply(sizes);

/// `l2` at 1920 x 1080 to a residual of 1e-5, for weights of the primal alpha^2, alpha in thousandths.
void solve_l2(benchmark::State& state, bool preconditioned, bool varied_counts) {
  constexpr Resolution k_resolution{1920, 1080};
  ReconstructionBuffers buffers = make_half(k_resolution, 10);
  if (varied_counts)
    for (std::size_t i = 0; i < buffers.dx_count.size(); ++i) buffers.dx_count[i] += std::round(3 * noise(1, i));
  const PoissonWeights weights = count_weights(buffers, static_cast<double>(state.range(0)) / 1000);
  const ScreenedPoissonProblem problem{buffers.primal, buffers.dx, buffers.dy, weights};
  ReconstructionStatistics statistics;
  for ([[maybe_unused]] auto iteration : state)
    statistics = solve(problem, {.preconditioned = preconditioned}).statistics;
  report(state, k_resolution, statistics);
}
void alphas(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("alpha")->Arg(10)->Arg(50)->Arg(200)->Arg(500)->Arg(1000);
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK_CAPTURE(solve_l2, preconditioned, true, false)->Apply(alphas);
BENCHMARK_CAPTURE(solve_l2, varied_counts, true, true)->Apply(alphas);
BENCHMARK_CAPTURE(solve_l2, plain, false, false)->Apply(alphas);

/// A hundred plain iterations on the problem of `weighted`: the measure of the time of others.
void hundred_plain_iterations(benchmark::State& state) {
  constexpr Resolution k_resolution{1920, 1080};
  const ReconstructionBuffers buffers = make_half(k_resolution, 10);
  const PoissonWeights weights = variance_weights(buffers, buffers, {});
  const ScreenedPoissonProblem problem{buffers.primal, buffers.dx, buffers.dy, weights};
  const SolverOptions options{.relative_residual = 1e-10, .max_iterations = 100, .preconditioned = false};
  ReconstructionStatistics statistics;
  for ([[maybe_unused]] auto iteration : state) statistics = solve(problem, options).statistics;
  report(state, k_resolution, statistics);
}
BENCHMARK(hundred_plain_iterations)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace gradslc
