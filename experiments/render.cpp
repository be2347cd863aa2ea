#include "experiments/render.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>

#include "core/file.h"
#include "experiments/build_info.h"
#include "experiments/memory_check.h"
#include "experiments/sha256.h"
#include "experiments/turns.h"
#include "film/film_io.h"

namespace gradslc {
namespace {

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

/// Half the budget, where its reconstruction is worth a rehearsal, and the budget.
std::vector<double> render_targets(const Budget& budget, bool reconstructs) {
  if (budget.kind == Budget::Kind::seconds && reconstructs) return {budget.value / 2, budget.value};
  return {budget.value};
}

const char* sampler_name(SamplerKind kind) {
  const std::span<const SamplerEntry> samplers = sampler_registry();
  return std::find_if(samplers.begin(), samplers.end(), [&](const SamplerEntry& s) { return s.kind == kind; })->name;
}

nlohmann::json counters_json(const IntegratorStatistics& statistics) {
  nlohmann::json counters = nlohmann::json::object();
  for (const IntegratorStatistics::Counter& counter : statistics.counters) counters[counter.name] = counter.value;
  return counters;
}

}  // namespace

RenderResult render_method(const Scene& scene, const MethodPlan& method, const RenderSettings& settings,
                           const Budget& budget, FilmLayers layers, const Progress& progress) {
  return render_method(scene, method, settings, budget, layers, real_makers(), progress);
}

RenderResult render_method(const Scene& scene, const MethodPlan& method, const RenderSettings& settings,
                           const Budget& budget, FilmLayers layers, const Makers& makers, const Progress& progress) {
  require_memory(plan_memory({method}, "memory", scene, settings, makers), makers.available_memory());
  nlohmann::json machine = machine_info();
  std::unique_ptr<Reconstruction> reconstruction = makers.reconstruction(method);
  MethodRun::Plan plan{method.name, settings, budget, layers, render_targets(budget, reconstruction != nullptr)};
  MethodRun::Reconstructions reconstructions;
  reconstructions.push_back(std::move(reconstruction));
  MethodRun run(std::move(plan), makers.integrator(method), std::move(reconstructions), scene, makers.clock);

  const double begin = makers.clock().wall;
  PointImage last;
  take_turns(
      std::span(&run, 1), 0, [&](std::size_t, PointImage point) { last = std::move(point); },
      [&](double fraction) {
        if (!progress || fraction <= 0) return;
        progress(fraction, (makers.clock().wall - begin) * (1 - fraction) / fraction, method.name);
      });
  return take_result(run, std::move(last), std::move(machine));
}

RenderResult take_result(MethodRun& run, PointImage final, nlohmann::json machine) {
  const CurvePoint& point = final.point;
  return {std::move(final.image), run.finished_film(), point.passes,         point.total().wall,
          point.total().cpu,      point.prepare.wall,  point.render.wall,    point.reconstruct.wall,
          run.statistics(),       run.traits(),        point.reconstruction, std::move(machine)};
}

void write_render(const std::filesystem::path& path, const RenderResult& result, const nlohmann::json& manifest) {
  write_exr(path, {result.image, film_layers(*result.film), {}});

  nlohmann::json full = manifest;
  full["passes"] = result.passes;
  full["seconds"] = {{"wall", result.wall_seconds},
                     {"cpu", result.cpu_seconds},
                     {"prepare", result.prepare_seconds},
                     {"render", result.render_seconds},
                     {"reconstruct", result.reconstruct_seconds}};
  full["rays"] = result.statistics.rays;
  full["counters"] = counters_json(result.statistics);
  full["invalid_samples"] = result.film->invalid_samples();
  full["traits"] = {{"gradients", result.traits.gradients},
                    {"biased", result.traits.biased},
                    {"truncated", result.traits.truncated},
                    {"one_set", result.traits.one_set}};
  if (result.reconstruction) full["reconstruction"] = to_json(*result.reconstruction);
  full["image"] = {{"file", path.filename().string()},
                   {"width", result.image.width()},
                   {"height", result.image.height()},
                   {"mean", channel_means(result.image)},
                   {"sha256", sha256_of_file(path)}};
  full["build"] = build_info();
  full["machine"] = result.machine;
  full["peak_memory_bytes"] = peak_memory_bytes();
  full["written"] = utc_now();
  write_file_atomically(std::filesystem::path(path).replace_extension(".json"), full.dump(2) + "\n");
}

nlohmann::json to_json(const ReconstructionStatistics& statistics) {
  return {{"iterations", statistics.iterations},
          {"relative_residual", statistics.relative_residual},
          {"converged", statistics.converged},
          {"outliers", statistics.outliers}};
}

nlohmann::json to_json(const MethodPlan& method) {
  return {{"name", method.name},
          {"integrator", method.integrator},
          {"parameters", method.parameters},
          {"reconstruction", method.reconstruction},
          {"reconstruction_parameters", method.reconstruction_parameters},
          {"render_of", method.render_of}};
}

nlohmann::json to_json(const RenderSettings& settings) {
  nlohmann::json components = nlohmann::json::array();
  if (settings.components.emission) components.push_back("emission");
  if (settings.components.direct) components.push_back("direct");
  if (settings.components.indirect) components.push_back("indirect");
  return {{"seed", settings.seed},
          {"max_depth", settings.max_depth},
          {"components", components},
          {"sampler", sampler_name(settings.sampler)}};
}

std::array<double, 3> channel_means(const RgbImage& image) {
  std::array<double, 3> sum{};
  for (const Rgb& pixel : image) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += double{pixel[static_cast<int>(c)]};
  }
  for (double& value : sum) value /= static_cast<double>(image.size());
  return sum;
}

}  // namespace gradslc
