#pragma once

#include <functional>
#include <memory>

#include "core/memory.h"
#include "experiments/clock.h"
#include "experiments/experiment.h"

namespace gradslc {

class Scene;

/// Where a run gets its parts from and how it tells the time: an argument, so that tests can give it methods whose
/// variance and speed are known.
struct Makers {
  std::function<std::unique_ptr<Integrator>(const MethodPlan&)> integrator;
  std::function<std::unique_ptr<Reconstruction>(const MethodPlan&)> reconstruction;  ///< may give null: none
  std::function<Scene(const ScenePlan&)> scene;
  Clock clock;
  std::function<double()> available_memory = gradslc::available_memory;  ///< bytes
};

/// The registries' integrators and reconstructions, scenes from their files, the system's time.
Makers real_makers();

/// Called now and then with the share of the work that is done, the seconds that the rest is likely to take, and what
/// is being done.
using Progress = std::function<void(double fraction, double eta_seconds, const std::string& what)>;

}  // namespace gradslc
