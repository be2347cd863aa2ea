#include "experiments/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/components.h"
#include "experiments/config_override.h"
#include "experiments/json_object_reader.h"

namespace gradslc {
namespace {

using nlohmann::json;

constexpr Range k_depth_range{1, 1024};
constexpr Range k_size_range{1, 32768};
constexpr double k_most_passes = 1 << 30;
constexpr double k_shortest_budget = 1e-3;  // seconds

/// Reads one config; what is wrong goes to `problems`.
class ConfigReader {
 public:
  ConfigReader(const JsonDocument& document, const std::filesystem::path& file, const ConfigOptions& options,
               const Registries& registries, Problems& problems)
      : document_(document), file_(file), options_(options), registries_(registries), problems_(problems) {}

  Experiment read();

 private:
  void read_settings(JsonObjectReader& reader);
  void read_components(JsonObjectReader& reader);
  void read_scenes(JsonObjectReader& reader);
  ScenePlan read_scene(const std::string& pointer);
  void read_methods(JsonObjectReader& reader);
  void read_budget(JsonObjectReader& reader);
  void read_reference(JsonObjectReader& reader);

  std::optional<int> optional_integer(JsonObjectReader& reader, const char* name, Range range, const char* unit,
                                      const char* meaning);
  std::optional<std::filesystem::path> existing_file(JsonObjectReader& reader, const char* name);
  void check_label(JsonObjectReader& reader, const std::string& label);
  /// Reports a name that an earlier plan of `plans` already has.
  template <class Plan>
  void check_unique(const std::vector<Plan>& plans, const std::string& name, const std::string& pointer);

  const JsonDocument& document_;
  const std::filesystem::path& file_;
  const ConfigOptions& options_;
  const Registries& registries_;
  Problems& problems_;
  Experiment experiment_;
};

Experiment ConfigReader::read() {
  JsonObjectReader reader(document_, "", problems_);
  if (!document_.root().is_object()) return {};
  experiment_.name = reader.text("name").value_or(file_.stem().string());
  check_label(reader, experiment_.name);
  experiment_.description = reader.text("description").value_or("");
  read_settings(reader);
  read_components(reader);
  read_scenes(reader);
  read_methods(reader);
  read_budget(reader);
  read_reference(reader);
  experiment_.reference.parts = experiment_.parts;
  reader.report_unknown_keys();
  return std::move(experiment_);
}

void ConfigReader::read_settings(JsonObjectReader& reader) {
  RenderSettings& settings = experiment_.settings;
  auto seed = static_cast<std::int64_t>(settings.seed);
  reader.integer("seed", seed, at_least(0), "", "seed of the first repeat");
  settings.seed = static_cast<std::uint64_t>(seed);
  reader.integer("repeats", experiment_.repeats, {1, 1e6}, "", "runs of everything, each with a seed of its own");
  reader.integer("max_depth", settings.max_depth, k_depth_range, "edges", "most edges of a path");
  reader.boolean("parts", experiment_.parts, "also writes each image split by how the light came");
  reader.boolean("debug", experiment_.debug, "also writes what each pixel cost and its largest contribution");
  std::vector<std::string> samplers;
  for (const SamplerEntry& entry : registries_.samplers) samplers.emplace_back(entry.name);
  const auto current = std::find_if(registries_.samplers.begin(), registries_.samplers.end(),
                                    [&](const SamplerEntry& entry) { return entry.kind == settings.sampler; });
  auto index = static_cast<std::size_t>(current - registries_.samplers.begin());
  reader.choice("sampler", index, samplers, "where random numbers come from");
  settings.sampler = registries_.samplers[index].kind;
}

void ConfigReader::read_components(JsonObjectReader& reader) {
  if (!reader.member("components")) return;
  Components components{false, false, false};
  const std::vector<std::string> elements = reader.elements("components");
  for (const std::string& element : elements) {
    const json& value = *document_.find(element);
    if (!value.is_string())
      problems_.add(document_.position(element), "must be a string, not " + kind_of(value));
    else if (!include_component(components, value.get<std::string>()))
      problems_.add(document_.position(element), fmt::format("unknown component \"{}\"{}", value.get<std::string>(),
                                                             suggestion(value.get<std::string>(), component_names())));
  }
  if (elements.empty() && document_.root().at("components").is_array())
    reader.problem("components", fmt::format("is empty; known: {}", fmt::join(component_names(), ", ")));
  experiment_.settings.components = components;
}

void ConfigReader::read_scenes(JsonObjectReader& reader) {
  if (!reader.member("scenes")) return reader.problem("scenes", "is missing: [{\"file\": \"scene.xml\"}, ...]");
  const std::vector<std::string> elements = reader.elements("scenes");
  if (elements.empty() && document_.root().at("scenes").is_array())
    reader.problem("scenes", "is empty: at least one scene is needed");
  for (const std::string& element : elements) {
    ScenePlan scene = read_scene(element);
    check_unique(experiment_.scenes, scene.name, element);
    experiment_.scenes.push_back(std::move(scene));
  }
}

ScenePlan ConfigReader::read_scene(const std::string& pointer) {
  JsonObjectReader reader(document_, pointer, problems_);
  ScenePlan scene;
  if (!document_.find(pointer)->is_object()) return scene;
  if (!reader.member("file")) reader.problem("file", "is missing: the scene's file");
  if (const auto file = existing_file(reader, "file")) scene.file = *file;
  const std::optional<std::string> name = reader.text("name");
  scene.name = name.value_or(scene.file.stem().string());
  if (name || !scene.file.empty()) check_label(reader, scene.name);
  scene.width = optional_integer(reader, "width", k_size_range, "pixels", "of the image");
  scene.height = optional_integer(reader, "height", k_size_range, "pixels", "of the image");
  scene.max_depth = optional_integer(reader, "max_depth", k_depth_range, "edges", "instead of the experiment's");
  reader.report_unknown_keys();
  return scene;
}

void ConfigReader::read_methods(JsonObjectReader& reader) {
  if (!reader.member("methods")) return reader.problem("methods", "is missing: [{\"integrator\": \"spt\"}, ...]");
  const std::vector<std::string> elements = reader.elements("methods");
  if (elements.empty() && document_.root().at("methods").is_array())
    reader.problem("methods", "is empty: at least one method is needed");
  for (const std::string& element : elements) {
    std::optional<MethodPlan> method = read_method(document_, element, registries_, problems_, experiment_.methods);
    if (!method) continue;
    check_unique(experiment_.methods, method->name, element);
    experiment_.methods.push_back(std::move(*method));
  }
}

void ConfigReader::read_budget(JsonObjectReader& reader) {
  const auto pointer = reader.member("budget");
  if (!pointer) return reader.problem("budget", "is missing: {\"seconds\": 20} or {\"spp\": 64}");
  JsonObjectReader budget(document_, *pointer, problems_);
  if (!document_.find(*pointer)->is_object()) return;
  std::int64_t spp = 0;
  double seconds = 0;
  budget.integer("spp", spp, {1, k_most_passes}, "samples per pixel", "of each method");
  budget.real("seconds", seconds, at_least(k_shortest_budget), "s", "of wall-clock time for each method");
  budget.report_unknown_keys();
  const bool by_spp = budget.member("spp").has_value(), by_seconds = budget.member("seconds").has_value();
  if (by_spp == by_seconds) return reader.problem("budget", "must hold one of \"spp\" and \"seconds\"");
  experiment_.budget.kind = by_spp ? Budget::Kind::spp : Budget::Kind::seconds;
  experiment_.budget.value = by_spp ? static_cast<double>(spp) : seconds;
}

void ConfigReader::read_reference(JsonObjectReader& reader) {
  const auto pointer = reader.member("reference");
  if (!pointer) return;
  JsonObjectReader reference(document_, *pointer, problems_);
  if (!document_.find(*pointer)->is_object()) return;
  ReferencePlan& plan = experiment_.reference;
  reference.integer("spp", plan.spp, {2, k_most_passes}, "samples per pixel", "of both halves together");
  if (const auto file = existing_file(reference, "file")) plan.file = *file;
  if (const auto method = reference.member("method")) {
    plan.method = read_method(document_, *method, registries_, problems_);
    if (plan.method && plan.method->reconstruction != "none")
      reference.problem("method", "must not be reconstructed: a reference is what the method itself converges to");
    if (plan.method) plan.resolved_method = resolved_method(*plan.method, registries_);
  }
  reference.report_unknown_keys();
  const bool rendered = reference.member("spp").has_value(), imported = reference.member("file").has_value();
  if (rendered == imported) return reader.problem("reference", "must hold one of \"spp\" and \"file\"");
  if (imported && plan.method) reference.problem("method", "has no effect on an imported reference; remove it");
  plan.kind = rendered ? ReferencePlan::Kind::render : ReferencePlan::Kind::file;
}

std::optional<int> ConfigReader::optional_integer(JsonObjectReader& reader, const char* name, Range range,
                                                  const char* unit, const char* meaning) {
  if (!reader.member(name)) return std::nullopt;
  int value = 0;
  reader.integer(name, value, range, unit, meaning);
  return value;
}

std::optional<std::filesystem::path> ConfigReader::existing_file(JsonObjectReader& reader, const char* name) {
  const std::optional<std::string> text = reader.text(name);
  if (!text) return std::nullopt;
  const ExpandedText expanded = expand_environment(*text, options_.environment);
  if (!expanded.error.empty()) {
    reader.problem(name, expanded.error);
    return std::nullopt;
  }
  std::filesystem::path path = std::filesystem::absolute(file_.parent_path() / expanded.text).lexically_normal();
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status))
    reader.problem(name, fmt::format("file \"{}\" does not exist", path.string()));
  else if (std::filesystem::is_directory(status))
    reader.problem(name, fmt::format("\"{}\" is a folder, a file is needed", path.string()));
  return path;
}

void ConfigReader::check_label(JsonObjectReader& reader, const std::string& label) {
  if (!is_label(label)) reader.problem("name", unusable_label(label));
}

template <class Plan>
void ConfigReader::check_unique(const std::vector<Plan>& plans, const std::string& name, const std::string& pointer) {
  const auto same = std::find_if(plans.begin(), plans.end(), [&](const Plan& plan) { return plan.name == name; });
  if (same != plans.end() && !name.empty())
    problems_.add(document_.position(join_pointer(pointer, "name")),
                  fmt::format("the name \"{}\" is given twice; add a \"name\" that tells them apart", name));
}

json resolved_scene(const ScenePlan& scene) {
  json resolved = {{"name", scene.name}, {"file", scene.file.string()}};
  if (scene.width) resolved["width"] = *scene.width;
  if (scene.height) resolved["height"] = *scene.height;
  if (scene.max_depth) resolved["max_depth"] = *scene.max_depth;
  return resolved;
}

/// A config that says all of the experiment explicitly: loading it gives the same experiment.
json resolved_config(const Experiment& experiment, const Registries& registries) {
  const RenderSettings& settings = experiment.settings;
  json resolved = {{"name", experiment.name},         {"description", experiment.description},
                   {"seed", settings.seed},           {"repeats", experiment.repeats},
                   {"max_depth", settings.max_depth}, {"components", names_of(settings.components)},
                   {"parts", experiment.parts},       {"debug", experiment.debug},
                   {"scenes", json::array()},         {"methods", json::array()}};
  for (const SamplerEntry& entry : registries.samplers)
    if (entry.kind == settings.sampler) resolved["sampler"] = entry.name;
  for (const ScenePlan& scene : experiment.scenes) resolved["scenes"].push_back(resolved_scene(scene));
  for (const MethodPlan& method : experiment.methods)
    resolved["methods"].push_back(resolved_method(method, registries));
  if (experiment.budget.kind == Budget::Kind::spp)
    resolved["budget"] = {{"spp", static_cast<std::int64_t>(experiment.budget.value)}};
  else
    resolved["budget"] = {{"seconds", experiment.budget.value}};
  if (experiment.reference.kind == ReferencePlan::Kind::render)
    resolved["reference"] = {{"spp", experiment.reference.spp}};
  if (experiment.reference.method) resolved["reference"]["method"] = experiment.reference.resolved_method;
  if (experiment.reference.kind == ReferencePlan::Kind::file)
    resolved["reference"] = {{"file", experiment.reference.file.string()}};
  return resolved;
}

}  // namespace

std::optional<Experiment> load_experiment(const std::filesystem::path& file, const ConfigOptions& options,
                                          const Registries& registries, Problems& problems) {
  JsonDocument document = JsonDocument::read(file);
  for (const std::string& assignment : options.overrides) apply_override(document, assignment);
  const std::size_t problems_before = problems.all().size();
  Experiment experiment = ConfigReader(document, file, options, registries, problems).read();
  if (problems.all().size() > problems_before) return std::nullopt;
  experiment.resolved = resolved_config(experiment, registries);
  return experiment;
}

}  // namespace gradslc
