#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "core/error.h"
#include "experiments/cli/commands.h"
#include "experiments/components.h"
#include "experiments/method_plan.h"
#include "experiments/metrics.h"
#include "experiments/parameter_list.h"
#include "materials/material.h"
#include "shifts/registry.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct Listed {
  std::string name, meaning;
  std::vector<ParameterInfo> parameters;
};

template <class Entry>
std::vector<Listed> named(std::span<const Entry> entries) {
  std::vector<Listed> listed;
  for (const Entry& entry : entries) listed.push_back({entry.name, entry.meaning, {}});
  return listed;
}

template <class Entry>
std::vector<Listed> with_parameters(std::span<const Entry> entries) {
  std::vector<Listed> listed = named(entries);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ParameterLister lister;
    entries[i].make()->describe(lister);
    listed[i].parameters = lister.parameters();
  }
  return listed;
}

struct Kind {
  const char* name;
  const char* meaning;
  std::vector<Listed> (*list)();
};

constexpr Kind k_kinds[] = {
    {"integrators", "methods, with their parameters", [] { return with_parameters(integrator_registry()); }},
    {"shifts", "how neighbouring pixels' samples are made alike", [] { return named(shift_registry()); }},
    {"reconstructions", "from gradients to an image, with their parameters",
     [] { return with_parameters(reconstruction_registry()); }},
    {"samplers", "where random numbers come from", [] { return named(sampler_registry()); }},
    {"metrics", "errors against a reference", [] { return named(metric_registry()); }},
    {"bsdfs", "materials of scene files", [] { return named(bsdf_registry()); }},
    {"components", "light by the number of edges of its path", [] { return named(component_registry()); }},
};

json as_json(const Listed& listed) {
  json entry = {{"name", listed.name}, {"meaning", listed.meaning}};
  if (listed.parameters.empty()) return entry;
  entry["parameters"] = json::array();
  for (const ParameterInfo& parameter : listed.parameters) entry["parameters"].push_back(to_json(parameter));
  return entry;
}

void print_parameters(const std::vector<ParameterInfo>& parameters) {
  std::size_t path_width = 0, allowed_width = 0, default_width = 0;
  for (const ParameterInfo& parameter : parameters) {
    path_width = std::max(path_width, parameter.path.size());
    allowed_width = std::max(allowed_width, allowed_values(parameter).size());
    default_width = std::max(default_width, default_text(parameter).size());
  }
  for (const ParameterInfo& parameter : parameters)
    fmt::print("    {:<{}}  {:<{}}  {:<{}}  {}\n", parameter.path, path_width, default_text(parameter), default_width,
               allowed_values(parameter), allowed_width, parameter.meaning);
}

void print(const std::vector<Listed>& entries) {
  std::size_t width = 0;
  for (const Listed& entry : entries) width = std::max(width, entry.name.size());
  for (const Listed& entry : entries) {
    fmt::print("{:<{}}  {}\n", entry.name, width, entry.meaning);
    print_parameters(entry.parameters);
  }
}

std::vector<Listed> entries_of(const std::string& kind) {
  std::vector<std::string> names;
  for (const Kind& candidate : k_kinds) {
    if (candidate.name == kind) return candidate.list();
    names.emplace_back(candidate.name);
  }
  throw_input_error("list", fmt::format("unknown kind \"{}\"{}", kind, suggestion(kind, names)));
}

struct ListArguments {
  std::string kind;
  bool print_json = false;
};

int list(const ListArguments& arguments) {
  const std::vector<Listed> entries =
      arguments.kind.empty() ? named(std::span<const Kind>(k_kinds)) : entries_of(arguments.kind);
  if (!arguments.print_json) {
    print(entries);
    return k_done;
  }
  json array = json::array();
  std::transform(entries.begin(), entries.end(), std::back_inserter(array), as_json);
  fmt::print("{}\n", array.dump(2));
  return k_done;
}

}  // namespace

Command list_command(CLI::App& parent) {
  const auto arguments = std::make_shared<ListArguments>();
  CLI::App& app = *parent.add_subcommand("list", "Lists what there is to choose from, with parameters and defaults");
  app.add_option("KIND", arguments->kind, "integrators, shifts, ...; without it, the kinds are listed");
  app.add_flag("--json", arguments->print_json, "Print JSON");
  app.footer(
      "Of each parameter: its key, its default, what it may be, and what it means.\n"
      "Example:\n  gradslc list integrators");
  return {&app, [arguments] { return list(*arguments); }};
}

}  // namespace gradslc
