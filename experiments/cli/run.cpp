#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <memory>

#include "core/parallel.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/console.h"
#include "experiments/cli/output_path.h"
#include "experiments/config.h"
#include "experiments/results_folder.h"
#include "experiments/runner.h"
#include "experiments/scene_check.h"

namespace gradslc {
namespace {

struct RunArguments {
  std::filesystem::path config, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> seed;
  std::optional<int> spp;
  std::optional<double> seconds;
  int threads = 0;
  bool dry_run = false, print_json = false, quiet = false;
};

int run(const RunArguments& arguments) {
  ConfigOptions options;
  if (arguments.seed) options.overrides.push_back(fmt::format("seed={}", *arguments.seed));
  if (arguments.spp) options.overrides.push_back(fmt::format("budget={{\"spp\": {}}}", *arguments.spp));
  if (arguments.seconds) options.overrides.push_back(fmt::format("budget={{\"seconds\": {}}}", *arguments.seconds));
  options.overrides.insert(options.overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  Problems problems;
  const std::optional<Experiment> experiment = load_experiment(arguments.config, options, all_registries(), problems);
  if (!experiment) return report_problems(problems);
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path("results") / file_name_for(experiment->name) : arguments.out;
  if (!arguments.dry_run) require_writable_folder(out);
  set_thread_count(arguments.threads);
  check_scenes(*experiment, problems);
  if (!problems.empty()) return report_problems(problems);
  if (arguments.dry_run) {
    for (const PlannedRun& planned : plan_experiment(*experiment, real_makers())) fmt::print("{}\n", describe(planned));
    return k_done;
  }
  Console console(arguments.quiet);
  run_experiment(*experiment, {out, [&](const std::string& line) { console.log(line); },
                               [&](double fraction, double eta, const std::string& what) {
                                 console.progress(fraction, eta, what);
                               }});
  if (arguments.print_json)
    fmt::print("{}\n", nlohmann::json{{"experiment", experiment->name}, {"out", out.string()}}.dump(2));
  else
    console.log("results: " + out.string());
  return k_done;
}

}  // namespace

Command run_command(CLI::App& parent) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App& app = *parent.add_subcommand("run", "Runs an experiment: all methods of a config on all of its scenes");
  app.add_option("CONFIG", arguments->config, "The experiment's JSON file")->required();
  app.add_option("-o,--out", arguments->out, "Results folder (default: results/<experiment's name>)");
  app.add_option("--set", arguments->overrides, "Key of the config: budget.spp=4, methods.1.cut_size=20, /seed=7")
      ->allow_extra_args(false);
  app.add_option("--seed", arguments->seed, "Seed instead of the config's")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  CLI::Option* spp = app.add_option("--spp", arguments->spp, "Budget instead of the config's: samples per pixel")
                         ->check(CLI::Range(1, std::numeric_limits<int>::max()));
  app.add_option("--seconds", arguments->seconds, "Budget instead of the config's: wall-clock time of each method")
      ->check(CLI::Range(1e-3, 1e9))
      ->excludes(spp);
  app.add_option("--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_flag(
      "--dry-run", arguments->dry_run,
      "Print what each method would take on each scene, and render nothing: light paths, VPLs expected, memory");
  app.add_flag("--json", arguments->print_json, "Print where the results lie as JSON to stdout");
  app.add_flag("--quiet", arguments->quiet, "Print errors only");
  app.footer(
      "What is already in the results folder is kept, so that an interrupted run goes on.\n"
      "Examples:\n"
      "  gradslc run configs/demo.json\n"
      "  gradslc run configs/cornell-equal-time.json --seconds 5 --set repeats=1 --out /tmp/quick");
  return {&app, [arguments] { return run(*arguments); }};
}

}  // namespace gradslc
