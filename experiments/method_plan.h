#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "experiments/experiment.h"
#include "experiments/json_document.h"
#include "experiments/problems.h"

namespace gradslc {

/// The tables that names in a config are looked up in.
struct Registries {
  std::span<const IntegratorEntry> integrators;
  std::span<const ReconstructionEntry> reconstructions;
  std::span<const SamplerEntry> samplers;
};
/// The program's.
Registries all_registries();

/// Reads the method at `pointer`, which must exist: an object {name, integrator, its parameters, reconstruction}, or
/// the integrator's name alone; a reconstruction is an object {type, its parameters} or its type alone. The name
/// defaults to the integrator's. {name, render_of, reconstruction} is the method of `earlier` that render_of names,
/// with another reconstruction of the same samples. nullopt: `problems` says why.
std::optional<MethodPlan> read_method(const JsonDocument& document, const std::string& pointer,
                                      const Registries& registries, Problems& problems,
                                      std::span<const MethodPlan> earlier = {});

/// The method as a config would give it, with every parameter at the value that it has.
nlohmann::json resolved_method(const MethodPlan& method, const Registries& registries);

/// Throws Error (input) where the method's names or parameters are not valid.
std::unique_ptr<Integrator> make_integrator(const MethodPlan& method, const Registries& registries);
/// nullptr for "none".
std::unique_ptr<Reconstruction> make_reconstruction(const MethodPlan& method, const Registries& registries);

/// Whether `name` can name a row of a table and, with what is special to a file system replaced, a file: 1 to 100 bytes
/// without control characters, no "." or blank first, no blank last.
bool is_label(const std::string& name);
/// The message about a name that is none.
std::string unusable_label(const std::string& name);

}  // namespace gradslc
