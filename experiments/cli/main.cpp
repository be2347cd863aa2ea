#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/build_info.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/process_environment.h"

namespace {

using namespace gradslc;

std::string version() {
  const nlohmann::json build = build_info();
  std::string text = "gradslc " GRADSLC_VERSION;
  if (build.at("git_commit").is_string())
    text += fmt::format(" ({}{})", build.at("git_commit").get<std::string>(),
                        build.at("git_dirty") == true ? ", with changes" : "");
  return text;
}

int fail(const std::string& message, int code) {
  fmt::print(stderr, "error: {}\n", message);
  return code;
}

/// Names the command that was meant where the first argument is none.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) == names.end())
    throw_input_error("gradslc", fmt::format("unknown command \"{}\"{}", argv[1], suggestion(argv[1], names)));
}

/// The first line of a text; CLI11 writes several in places.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

int run(int argc, char** argv) {
  CLI::App app("Gradient-domain stochastic lightcuts: a testbed for equal-time comparisons", "gradslc");
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  gradslc render scene.xml --method spt --spp 64 -o image.exr\n"
      "  gradslc run configs/demo.json\n"
      "  gradslc compare image.exr reference.exr\n"
      "  gradslc list integrators\n"
      "Exit codes: 0 done, 1 failed, 2 bad input. COMMAND --help says more.");
  const std::vector<Command> commands = {render_command(app),  run_command(app),         report_command(app),
                                         compare_command(app), reconstruct_command(app), info_command(app),
                                         list_command(app),    validate_command(app)};
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return fail(first_line(error.what()) + "; --help shows the options", k_bad_input);
  }
  for (const Command& command : commands)
    if (command.app->parsed()) return command.run();
  return k_done;
}

}  // namespace

int main(int argc, char** argv) {
  set_process_environment(argv);
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.kind() == Error::Kind::input ? k_bad_input : k_failed;
  } catch (const std::bad_alloc&) {
    return fail("out of memory", k_failed);
  } catch (const std::exception& error) {
    return fail(error.what(), k_failed);
  }
}
