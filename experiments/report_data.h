#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "experiments/plot.h"
#include "experiments/summary.h"

namespace gradslc {

/// A picture in a report.
struct ReportImage {
  std::string caption;
  std::filesystem::path file;  ///< relative to the results folder
  std::string png;             ///< its bytes
};

struct SceneReport {
  SceneSummary summary;
  std::vector<std::string> verdict;
  std::string conditions;           ///< how its runs were made: a sentence or two
  std::filesystem::path plot_file;  ///< relative to the results folder
  std::optional<LogPlot> plot;      ///< none without errors
  std::string plot_id;
  std::vector<ReportImage> images, error_images;
};

/// All that a report shows, read from a results folder.
struct ReportData {
  std::string name;                     ///< the experiment's
  std::vector<std::string> conditions;  ///< build, machine, load: a sentence each
  std::vector<SceneReport> scenes;
};
ReportData read_report_data(const std::filesystem::path& results_folder);

/// relmse over seconds of all methods of a scene, at the curve points that all repeats of a method have (a mean over
/// others would jump); nullopt where no errors were measured.
std::optional<LogPlot> convergence_plot(std::span<const ResultRow> rows, const std::string& scene);

std::string report_markdown(const ReportData& data);
std::string report_html(const ReportData& data);

}  // namespace gradslc
