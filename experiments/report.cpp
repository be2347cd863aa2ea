#include "experiments/report.h"

#include "core/file.h"
#include "experiments/report_data.h"
#include "experiments/tables.h"

namespace gradslc {

void write_report(const std::filesystem::path& results_folder) {
  const ReportData data = read_report_data(results_folder);
  std::vector<SceneSummary> summaries;
  for (const SceneReport& scene : data.scenes) {
    summaries.push_back(scene.summary);
    if (scene.plot) write_file_atomically(results_folder / scene.plot_file, to_svg(*scene.plot, scene.plot_id));
    for (const ReportImage& image : scene.images) write_file_atomically(results_folder / image.file, image.png);
    for (const ReportImage& image : scene.error_images) write_file_atomically(results_folder / image.file, image.png);
  }
  write_file_atomically(results_folder / "table.tex", latex_tables(summaries));
  write_file_atomically(results_folder / "report.md", report_markdown(data));
  write_file_atomically(results_folder / "report.html", report_html(data));
}

}  // namespace gradslc
