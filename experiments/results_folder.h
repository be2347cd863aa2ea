#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "experiments/experiment.h"
#include "experiments/results.h"

namespace gradslc {

/// The files of one experiment's results and the right to write them.
///
///     experiment.json                          the resolved config
///     results.csv                              all rows
///     report.md, report.html, table.tex, plots/
///     references/                              rendered references, unless GRADSLC_REFERENCES names another folder
///     runs/<scene>/<method>/repeat-<r>/        image.exr, image.json (manifest), convergence.csv
class ResultsFolder {
 public:
  /// Makes the folder where it is missing, locks it until destruction, and checks that it holds this experiment's
  /// results or none. Error where another process has the lock (failure), where it belongs to another config, or where
  /// it cannot be written (input). Changes nothing before these are known.
  ResultsFolder(std::filesystem::path root, const Experiment& experiment);
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path run_folder(const std::string& scene, const std::string& method, int repeat) const;
  /// Rows of a run that is complete, else nothing. Error (input) where the run was made from another content of its
  /// scene.
  std::optional<std::vector<ResultRow>> complete_run(const std::string& scene, const std::string& scene_hash,
                                                     const std::string& method, int repeat) const;

 private:
  void lock();
  void claim(const Experiment& experiment) const;

  std::filesystem::path root_;
  int lock_ = -1;  // descriptor of the locked file
};

/// `name` as a file name: letters, digits, '.', '_' and '-' stay; where something else was replaced, a few digits of a
/// hash keep different names apart.
std::string file_name_for(const std::string& name);

std::filesystem::path run_path(const std::filesystem::path& root, const std::string& scene, const std::string& method,
                               int repeat);

}  // namespace gradslc
