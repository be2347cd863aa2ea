#include "experiments/method_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "experiments/json_object_reader.h"
#include "experiments/parameter_writer.h"

namespace gradslc {
namespace {

using nlohmann::json;

constexpr const char* k_no_reconstruction = "none";
constexpr std::size_t k_longest_label = 100;  // bytes; file systems take 255

template <class Entry>
const Entry* find_entry(std::span<const Entry> entries, std::string_view name) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

template <class Entry>
std::string unknown_name(const char* what, const std::string& name, std::span<const Entry> entries) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return fmt::format("unknown {} \"{}\"{}", what, name, suggestion(name, names));
}

json without_keys(json object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) object.erase(key);
  return object;
}

void read_reconstruction(const JsonDocument& document, const std::string& pointer, const Registries& registries,
                         Problems& problems, MethodPlan& method) {
  const json& given = *document.find(pointer);
  if (given.is_string()) {
    method.reconstruction = given.get<std::string>();
    if (!find_entry(registries.reconstructions, method.reconstruction))
      problems.add(document.position(pointer),
                   unknown_name("reconstruction", method.reconstruction, registries.reconstructions));
    return;
  }
  JsonObjectReader reader(document, pointer, problems);
  method.reconstruction = reader.text("type").value_or(k_no_reconstruction);
  if (const ReconstructionEntry* entry = find_entry(registries.reconstructions, method.reconstruction)) {
    entry->make()->describe(reader);
    reader.report_unknown_keys();
  } else {
    reader.problem("type", unknown_name("reconstruction", method.reconstruction, registries.reconstructions));
  }
  if (given.is_object()) method.reconstruction_parameters = without_keys(given, {"type"});
}

/// What a method has of the one whose samples it reconstructs.
void read_render_of(JsonObjectReader& reader, std::span<const MethodPlan> earlier, MethodPlan& method) {
  method.render_of = reader.text("render_of").value_or("");
  if (!reader.member("name")) reader.problem("name", "is missing: a name that tells it from the method that renders");
  std::vector<std::string> names;
  for (const MethodPlan& other : earlier) {
    if (!other.render_of.empty()) continue;
    names.push_back(other.name);
    if (other.name == method.render_of) method.integrator = other.integrator, method.parameters = other.parameters;
  }
  if (method.integrator.empty())
    reader.problem("render_of", fmt::format("no earlier method with samples of its own has the name \"{}\"{}",
                                            method.render_of, suggestion(method.render_of, names)));
  reader.report_unknown_keys();
}

void read_method_object(const JsonDocument& document, const std::string& pointer, const Registries& registries,
                        std::span<const MethodPlan> earlier, Problems& problems, MethodPlan& method) {
  JsonObjectReader reader(document, pointer, problems);
  if (document.find(pointer)->is_object() && document.find(pointer)->contains("render_of")) {
    method.name = reader.text("name").value_or("");
    if (const auto reconstruction = reader.member("reconstruction"))
      read_reconstruction(document, *reconstruction, registries, problems, method);
    return read_render_of(reader, earlier, method);
  }
  method.integrator = reader.text("integrator").value_or("");
  method.name = reader.text("name").value_or(method.integrator);
  if (const auto reconstruction = reader.member("reconstruction"))
    read_reconstruction(document, *reconstruction, registries, problems, method);
  const json& given = *document.find(pointer);
  if (!given.is_object()) return;
  method.parameters = without_keys(given, {"name", "integrator", "reconstruction"});
  if (!given.contains("integrator")) {
    reader.problem("integrator", "is missing: the name of the method's integrator");
  } else if (const IntegratorEntry* entry = find_entry(registries.integrators, method.integrator)) {
    entry->make()->describe(reader);
    reader.report_unknown_keys();
  } else if (!method.integrator.empty()) {
    reader.problem("integrator", unknown_name("integrator", method.integrator, registries.integrators));
  }
}

/// Reads `parameters` into `target`; throws the first problem.
template <class Described>
void apply_parameters(Described& target, const MethodPlan& method, const json& parameters) {
  const JsonDocument document = JsonDocument::from_value("method " + method.name, parameters);
  Problems problems;
  JsonObjectReader reader(document, "", problems);
  target.describe(reader);
  reader.report_unknown_keys();
  if (!problems.empty()) throw problems.all().front();
}

template <class Described>
json parameters_of(Described& described) {
  JsonParameterWriter writer;
  described.describe(writer);
  return writer.values();
}

}  // namespace

std::optional<MethodPlan> read_method(const JsonDocument& document, const std::string& pointer,
                                      const Registries& registries, Problems& problems,
                                      std::span<const MethodPlan> earlier) {
  const std::size_t problems_before = problems.all().size();
  MethodPlan method;
  method.parameters = json::object();
  method.reconstruction = k_no_reconstruction;
  method.reconstruction_parameters = json::object();
  if (const json& given = *document.find(pointer); given.is_string()) {
    method.name = method.integrator = given.get<std::string>();
    if (!find_entry(registries.integrators, method.integrator))
      problems.add(document.position(pointer), unknown_name("integrator", method.integrator, registries.integrators));
  } else {
    read_method_object(document, pointer, registries, earlier, problems, method);
  }
  if (problems.all().size() == problems_before && !is_label(method.name))
    problems.add(document.position(join_pointer(pointer, "name")), unusable_label(method.name));
  if (problems.all().size() > problems_before) return std::nullopt;
  return method;
}

nlohmann::json resolved_method(const MethodPlan& method, const Registries& registries) {
  json resolved = json::object();
  if (method.render_of.empty()) {
    resolved = parameters_of(*make_integrator(method, registries));
    resolved["integrator"] = method.integrator;
  } else {
    resolved["render_of"] = method.render_of;
  }
  resolved["name"] = method.name;
  const auto reconstruction = make_reconstruction(method, registries);
  resolved["reconstruction"] = reconstruction ? parameters_of(*reconstruction) : json::object();
  resolved["reconstruction"]["type"] = method.reconstruction;
  return resolved;
}

std::unique_ptr<Integrator> make_integrator(const MethodPlan& method, const Registries& registries) {
  const IntegratorEntry* entry = find_entry(registries.integrators, method.integrator);
  if (!entry)
    throw_input_error("method " + method.name, unknown_name("integrator", method.integrator, registries.integrators));
  std::unique_ptr<Integrator> integrator = entry->make();
  apply_parameters(*integrator, method, method.parameters);
  return integrator;
}

std::unique_ptr<Reconstruction> make_reconstruction(const MethodPlan& method, const Registries& registries) {
  if (method.reconstruction == k_no_reconstruction && method.reconstruction_parameters.empty()) return nullptr;
  const ReconstructionEntry* entry = find_entry(registries.reconstructions, method.reconstruction);
  if (!entry)
    throw_input_error("method " + method.name,
                      unknown_name("reconstruction", method.reconstruction, registries.reconstructions));
  std::unique_ptr<Reconstruction> reconstruction = entry->make();
  apply_parameters(*reconstruction, method, method.reconstruction_parameters);
  return reconstruction;
}

bool is_label(const std::string& name) {
  if (name.empty() || name.size() > k_longest_label) return false;
  if (name.front() == '.' || name.front() == ' ' || name.back() == ' ') return false;
  return std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < ' ' || byte == 0x7f;
  });
}

std::string unusable_label(const std::string& name) {
  return fmt::format(
      "{} is no usable name: 1 to {} bytes, no control characters, no \".\" or blank first, no blank last",
      json(name).dump(), k_longest_label);
}

}  // namespace gradslc
