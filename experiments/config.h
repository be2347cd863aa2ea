#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/experiment.h"
#include "experiments/method_plan.h"
#include "experiments/path_text.h"
#include "experiments/problems.h"

namespace gradslc {

struct ConfigOptions {
  std::vector<std::string> overrides;  ///< as config_override.h reads them, applied in order
  Environment environment = process_environment();
};

/// Reads an experiment's config, a JSON object with comments:
///
///     name (default: the file's), description, seed, repeats, max_depth, components, sampler, parts, debug,
///     scenes: [{file, name, width, height, max_depth}], methods: as read_method() takes them,
///     budget: {seconds} or {spp}, reference (optional): {spp} or {file}
///
/// Paths are relative to the config's folder, and ${NAME} in them is an environment variable. Throws Error (input)
/// where the file cannot be read, is not JSON, or an override leads nowhere. Everything that is wrong with the content
/// goes to `problems`; nullopt if anything is.
std::optional<Experiment> load_experiment(const std::filesystem::path& file, const ConfigOptions& options,
                                          const Registries& registries, Problems& problems);

}  // namespace gradslc
