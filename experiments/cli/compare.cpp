#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/exr.h"
#include "experiments/cli/commands.h"
#include "experiments/metrics.h"

namespace gradslc {
namespace {

struct CompareArguments {
  std::filesystem::path image, reference;
  bool print_json = false;
};

int compare(const CompareArguments& arguments) {
  const RgbImage image = read_exr(arguments.image).image;
  const RgbImage reference = read_exr(arguments.reference).image;
  nlohmann::ordered_json values;
  for (const Metric& metric : compare_images(image, reference)) {
    values[metric.name] = metric.value;
    if (!arguments.print_json) fmt::print("{:<16} {:.6g}\n", metric.name, metric.value);
  }
  if (arguments.print_json) fmt::print("{}\n", values.dump(2));
  return k_done;
}

}  // namespace

Command compare_command(CLI::App& parent) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App& app = *parent.add_subcommand("compare", "Prints the errors of an image against a reference");
  app.add_option("IMAGE", arguments->image, "EXR file")->required();
  app.add_option("REFERENCE", arguments->reference, "EXR file of the same size")->required();
  app.add_flag("--json", arguments->print_json, "Print a JSON object of metric names and values");
  app.footer(
      "Squares are plain ones here: they carry the reference's own noise.\n"
      "Example:\n  gradslc compare image.exr reference.exr --json");
  return {&app, [arguments] { return compare(*arguments); }};
}

}  // namespace gradslc
