#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "experiments/makers.h"
#include "experiments/method_run.h"

namespace gradslc {

/// A method's image at the end of its budget, and what it cost.
struct RenderResult {
  RgbImage image;
  std::shared_ptr<const Film> film;
  int passes = 0;
  double wall_seconds = 0, cpu_seconds = 0;                                 ///< prepare + render + reconstruct
  double prepare_seconds = 0, render_seconds = 0, reconstruct_seconds = 0;  ///< wall
  IntegratorStatistics statistics;
  IntegratorTraits traits;
  std::optional<ReconstructionStatistics> reconstruction;
  nlohmann::json machine;  ///< machine_info() when rendering began
};

/// Renders one method to the end of its budget. Where that is in seconds and the method has a reconstruction, it is
/// also run once at half of the budget, uncharged, so that the last one's time can be predicted. `layers`: what the
/// film records beside gradients, which are the method's own.
RenderResult render_method(const Scene& scene, const MethodPlan& method, const RenderSettings& settings,
                           const Budget& budget, FilmLayers layers, const Progress& progress);
RenderResult render_method(const Scene& scene, const MethodPlan& method, const RenderSettings& settings,
                           const Budget& budget, FilmLayers layers, const Makers& makers, const Progress& progress);

/// The result of a run that is done; `final` is its last point by one of its reconstructions.
RenderResult take_result(MethodRun& run, PointImage final, nlohmann::json machine);

/// Writes the image with the film's layers as EXR to `path`, and beside it, with the extension .json, `manifest` with
/// what is known here added: passes, stage timings, counters, build, machine, peak memory, the image's mean and
/// checksum. Both all or nothing, the manifest last: where it exists, the image is complete.
void write_render(const std::filesystem::path& path, const RenderResult& result, const nlohmann::json& manifest);

/// A method's plan as manifests hold it.
nlohmann::json to_json(const MethodPlan& method);
nlohmann::json to_json(const RenderSettings& settings);
nlohmann::json to_json(const ReconstructionStatistics& statistics);

/// Mean of an image per channel.
std::array<double, 3> channel_means(const RgbImage& image);

}  // namespace gradslc
