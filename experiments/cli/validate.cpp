#include <fmt/format.h>

#include <memory>

#include "experiments/cli/commands.h"
#include "experiments/cli/console.h"
#include "experiments/config.h"
#include "experiments/scene_check.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct ValidateArguments {
  std::filesystem::path config;
  std::vector<std::string> overrides;
  bool print_json = false, quiet = false;
};

std::optional<Experiment> check(const ValidateArguments& arguments, Problems& problems) {
  try {
    std::optional<Experiment> experiment =
        load_experiment(arguments.config, {.overrides = arguments.overrides}, all_registries(), problems);
    if (experiment) check_scenes(*experiment, problems);
    return experiment;
  } catch (const Error& error) {
    if (error.kind() == Error::Kind::failure) throw;
    problems.add(error.where(), error.message());
    return std::nullopt;
  }
}

json as_json(const Error& error) {
  const SourcePosition& where = error.where();
  return {{"file", where.file},
          {"line", where.line},
          {"column", where.column},
          {"pointer", where.pointer},
          {"message", error.message()}};
}

int validate(const ValidateArguments& arguments) {
  Problems problems;
  const std::optional<Experiment> experiment = check(arguments, problems);
  if (arguments.print_json) {
    json found = json::array();
    for (const Error& error : problems.all()) found.push_back(as_json(error));
    fmt::print("{}\n", json{{"valid", problems.empty()}, {"problems", std::move(found)}}.dump(2));
    return problems.empty() ? k_done : k_bad_input;
  }
  if (!problems.empty()) return report_problems(problems);
  if (!arguments.quiet)
    fmt::print("{}: valid: {} methods on {} scenes, {} repeats\n", arguments.config.string(),
               experiment->methods.size(), experiment->scenes.size(), experiment->repeats);
  return k_done;
}

}  // namespace

Command validate_command(CLI::App& parent) {
  const auto arguments = std::make_shared<ValidateArguments>();
  CLI::App& app =
      *parent.add_subcommand("validate", "Checks a config and its scenes, and reports all problems at once");
  app.add_option("CONFIG", arguments->config, "The experiment's JSON file")->required();
  app.add_option("--set", arguments->overrides, "Key of the config, as run takes it")->allow_extra_args(false);
  app.add_flag("--json", arguments->print_json, "Print JSON: valid, and the problems with their positions");
  app.add_flag("--quiet", arguments->quiet, "Print errors only");
  app.footer("Example:\n  gradslc validate configs/demo.json");
  return {&app, [arguments] { return validate(*arguments); }};
}

}  // namespace gradslc
