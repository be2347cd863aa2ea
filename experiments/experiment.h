#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "reconstruction/reconstruction.h"

namespace gradslc {

struct ScenePlan {
  std::string name;
  std::filesystem::path file;  ///< absolute, or relative to the working folder; environment variables expanded
  std::optional<int> width, height;
  std::optional<int> max_depth;  ///< overrides the experiment's
};

/// One method as the config says it: what a row of the table is.
struct MethodPlan {
  std::string name;
  std::string integrator;
  nlohmann::json parameters;   ///< the integrator's keys only, as written; validated
  std::string reconstruction;  ///< name in the registry; "none" by default
  nlohmann::json reconstruction_parameters;
  /// An earlier method whose very samples this one reconstructs in another way; empty: it renders its own.
  std::string render_of;
};

struct Budget {
  enum class Kind : std::uint8_t { spp, seconds };
  Kind kind = Kind::spp;
  double value = 16;  ///< passes, or wall-clock seconds
};

struct ReferencePlan {
  enum class Kind : std::uint8_t { none, render, file };
  Kind kind = Kind::none;
  int spp = 0;                 ///< of both halves together
  std::filesystem::path file;  ///< an imported image
  /// What renders it, where that is not `spt` with its defaults: an unbiased method, without reconstruction.
  std::optional<MethodPlan> method;
  nlohmann::json resolved_method;  ///< with all its parameters; null without a method
  bool parts = false;              ///< of the light that VPLs can represent too
};

/// A config, resolved and validated: everything that a run depends on.
struct Experiment {
  std::string name, description;
  RenderSettings settings;  ///< seed, max_depth, components, sampler
  int repeats = 1;
  bool parts = false, debug = false;
  std::vector<ScenePlan> scenes;
  std::vector<MethodPlan> methods;
  Budget budget;
  ReferencePlan reference;
  nlohmann::json resolved;  ///< the whole config after defaults and --set, for the manifest
};

/// Makes the integrator of a method with its parameters read. Error where they are not valid.
std::unique_ptr<Integrator> make_integrator(const MethodPlan& method);
/// nullptr for "none".
std::unique_ptr<Reconstruction> make_reconstruction(const MethodPlan& method);

}  // namespace gradslc
