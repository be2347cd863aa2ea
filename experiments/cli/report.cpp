#include "experiments/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/error.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/console.h"

namespace gradslc {
namespace {

struct ReportArguments {
  std::filesystem::path folder;
  bool quiet = false;
};

int report(const ReportArguments& arguments) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(arguments.folder, ignored))
    throw_input_error(arguments.folder.string(), "is not a folder; the results folder of a run is needed");
  write_report(arguments.folder);
  Console(arguments.quiet).log("report: " + arguments.folder.string());
  return k_done;
}

}  // namespace

Command report_command(CLI::App& parent) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App& app = *parent.add_subcommand("report", "Writes a results folder's tables and plots anew from its rows");
  app.add_option("DIR", arguments->folder, "Results folder of a run")->required();
  app.add_flag("--quiet", arguments->quiet, "Print errors only");
  app.footer("Example:\n  gradslc report results/demo");
  return {&app, [arguments] { return report(*arguments); }};
}

}  // namespace gradslc
