#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/experiment.h"
#include "experiments/makers.h"
#include "experiments/memory_check.h"

namespace gradslc {

struct RunOptions {
  std::filesystem::path out;                    ///< the results folder
  std::function<void(const std::string&)> log;  ///< one line at a time; may be empty
  Progress progress;                            ///< may be empty
};

/// Runs an experiment and writes its results folder (results_folder.h). Comparisons - all methods of one scene and
/// repeat, taking turns - are done one after the other; those that the folder already has whole are kept. Error where
/// the folder, a scene or a method is no good; what was complete stays.
void run_experiment(const Experiment& experiment, const RunOptions& options);
void run_experiment(const Experiment& experiment, const RunOptions& options, const Makers& makers);

/// What every method is expected to need on every scene. Loads the scenes and traces pilot light paths.
std::vector<PlannedRun> plan_experiment(const Experiment& experiment, const Makers& makers);

/// Seed of a repeat, the same for all methods: repeats and experiments' seeds are hashed, not added.
std::uint64_t repeat_seed(std::uint64_t experiment_seed, int repeat);

}  // namespace gradslc
