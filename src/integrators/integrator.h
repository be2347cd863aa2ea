#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/parameters.h"
#include "film/film.h"
#include "integrators/memory_plan.h"
#include "integrators/pass_schedule.h"
#include "integrators/path_log.h"
#include "samplers/sampler.h"

namespace gradslc {

class Scene;

/// Light by the number D of edges of its path (DESIGN 2): emission D = 1, direct D = 2, indirect D >= 3.
struct Components {
  bool emission = true, direct = true, indirect = true;
  bool operator==(const Components&) const = default;
  constexpr bool includes(int edges) const { return edges <= 1 ? emission : edges == 2 ? direct : indirect; }
};

/// What is estimated, and with which random numbers: the same for all methods of a comparison.
struct RenderSettings {
  std::uint64_t seed = 1;
  int max_depth = 7;  ///< most edges of a path, >= 1
  Components components;
  SamplerKind sampler = SamplerKind::sobol;
};

/// What a method says of its own result.
struct IntegratorTraits {
  bool gradients = false;  ///< fills dx and dy of the film
  bool biased = false;     ///< its expectation is not the estimand
  bool truncated = false;  ///< vpl.max_bounces cuts paths that max_depth allows
  bool one_set = false;    ///< one VPL set for the whole run: converges to that set's image
};

/// What rendering has cost so far, summed over all passes.
struct IntegratorStatistics {
  std::uint64_t rays = 0;  ///< all rays: closest-hit and shadow
  struct Counter {
    std::string name;  ///< snake_case, with its unit where it has one ("vpls_per_set", "trace_seconds")
    double value;
  };
  std::vector<Counter> counters;
};

/// A method. Knows nothing of budgets, files or other methods.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Declares (and so reads, writes or lists) the method's parameters. Called before prepare().
  virtual void describe(ParameterVisitor& visitor) = 0;
  /// Checks parameters against each other and does what is due once per run. `scene` must outlive the integrator.
  virtual void prepare(const Scene& scene, const RenderSettings& settings) = 0;
  /// Adds one sample per pixel to `film`, to the half that the pass belongs to, and closes the set where it ends.
  /// Passes may be rendered in any order of sets; the same pass adds the same bits for any number of threads.
  virtual void render_pass(std::uint32_t pass, Film& film) = 0;
  /// From now on, the probe's sample is logged when its pass is rendered; other pixels of that pass may be left out.
  void set_probe(const Probe& probe) { probe_ = probe; }
  /// What prepare() and render_pass() would take with these settings; renders nothing. Only after describe().
  virtual MemoryPlan plan_memory(const Scene&, const RenderSettings&) const { return {}; }
  virtual IntegratorTraits traits() const = 0;  ///< valid after prepare()
  virtual IntegratorStatistics statistics() const = 0;

 protected:
  LoggedSamples logged_samples(const PassSlot& slot, const Film& film) const {
    return {film.layers().debug, probe_, slot.pass};
  }

 private:
  Probe probe_;
};

struct IntegratorEntry {
  const char* name;
  const char* meaning;
  std::unique_ptr<Integrator> (*make)();
};
/// The only list of integrators.
std::span<const IntegratorEntry> integrator_registry();

}  // namespace gradslc
