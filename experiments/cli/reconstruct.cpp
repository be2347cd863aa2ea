#include "experiments/reconstruct.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "core/parallel.h"
#include "experiments/build_info.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/console.h"
#include "experiments/cli/output_path.h"
#include "experiments/clock.h"
#include "experiments/config_override.h"
#include "experiments/method_plan.h"
#include "experiments/render.h"
#include "experiments/sha256.h"
#include "reconstruction/reconstruction.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct ReconstructArguments {
  std::filesystem::path run, output;
  std::string type;
  std::vector<std::string> overrides;
  int threads = 0;
  bool print_json = false;
};

/// A method that has the reconstruction that --type and --set ask for.
std::optional<MethodPlan> method_of(const ReconstructArguments& arguments, Problems& problems) {
  JsonDocument document =
      JsonDocument::from_value("--type", {{"integrator", "spt"}, {"reconstruction", {{"type", arguments.type}}}});
  for (const std::string& assignment : arguments.overrides) apply_override(document, "reconstruction." + assignment);
  return read_method(document, "", all_registries(), problems);
}

void check_gradients(const ExrImage& run, const ReconstructArguments& arguments) {
  if (run.layers.contains("dx")) return;
  for (const ReconstructionEntry& entry : reconstruction_registry())
    if (arguments.type == entry.name && entry.needs_gradients)
      throw_input_error(arguments.run.string(), fmt::format("has no gradients, which {} needs", entry.name));
}

int reconstruct(const ReconstructArguments& arguments) {
  Problems problems;
  const std::optional<MethodPlan> method = method_of(arguments, problems);
  if (!method) return report_problems(problems);
  if (arguments.output.extension() != ".exr") throw_input_error(arguments.output.string(), "must end in .exr");
  require_writable_file(arguments.output);
  set_thread_count(arguments.threads);

  std::unique_ptr<Reconstruction> reconstruction = make_reconstruction(*method, all_registries());
  const ExrImage run = read_exr(arguments.run);
  check_gradients(run, arguments);
  const ReconstructionInput input = reconstruction_input(run, arguments.run);
  ReconstructionResult result{.image = input.combined.primal, .statistics = {}};
  const Seconds seconds = measure(system_time, [&] {
    if (reconstruction) result = reconstruction->reconstruct(input);
  });
  write_exr(arguments.output, {result.image, {}, {}});
  const json manifest = {{"run", arguments.run.string()},
                         {"run_sha256", sha256_of_file(arguments.run)},
                         {"reconstruction", resolved_method(*method, all_registries()).at("reconstruction")},
                         {"statistics", to_json(result.statistics)},
                         {"seconds", {{"wall", seconds.wall}, {"cpu", seconds.cpu}}},
                         {"image",
                          {{"file", arguments.output.filename().string()},
                           {"mean", channel_means(result.image)},
                           {"sha256", sha256_of_file(arguments.output)}}},
                         {"build", build_info()}};
  write_file_atomically(std::filesystem::path(arguments.output).replace_extension(".json"), manifest.dump(2) + "\n");
  const ReconstructionStatistics& statistics = result.statistics;
  if (arguments.print_json)
    fmt::print("{}\n", manifest.dump(2));
  else
    fmt::print("{}: {} iterations, relative residual {:.2g}, {} values left out, {:.2f} s\n", arguments.output.string(),
               statistics.iterations, statistics.relative_residual, statistics.outliers, seconds.wall);
  if (statistics.converged) return k_done;
  fmt::print(stderr, "{}: did not converge\n", arguments.output.string());
  return k_failed;
}

}  // namespace

Command reconstruct_command(CLI::App& parent) {
  const auto arguments = std::make_shared<ReconstructArguments>();
  CLI::App& app = *parent.add_subcommand("reconstruct", "Reconstructs an image again from the layers of a run's EXR");
  app.add_option("RUN", arguments->run, "EXR file that render or run has written")->required();
  app.add_option("--type", arguments->type, "Reconstruction: see list reconstructions")->required();
  app.add_option("--set", arguments->overrides, "Parameter of the reconstruction: key=value")->allow_extra_args(false);
  app.add_option("-o,--output", arguments->output, "Image (.exr), and a .json manifest beside it")->required();
  app.add_option("--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_flag("--json", arguments->print_json, "Print the manifest to stdout");
  app.footer(
      "Examples:\n"
      "  gradslc reconstruct run.exr --type l1 -o l1.exr\n"
      "  gradslc reconstruct run.exr --type l2 --set alpha=0.1 --set outliers.remove=true -o l2.exr");
  return {&app, [arguments] { return reconstruct(*arguments); }};
}

}  // namespace gradslc
