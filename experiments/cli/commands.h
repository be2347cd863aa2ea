#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace gradslc {

/// A subcommand of gradslc. `run` is called once its options are parsed and returns the exit code; it may throw Error.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command render_command(CLI::App& parent);
Command run_command(CLI::App& parent);
Command report_command(CLI::App& parent);
Command reconstruct_command(CLI::App& parent);
Command compare_command(CLI::App& parent);
Command info_command(CLI::App& parent);
Command list_command(CLI::App& parent);
Command validate_command(CLI::App& parent);

constexpr int k_done = 0, k_failed = 1, k_bad_input = 2;

}  // namespace gradslc
