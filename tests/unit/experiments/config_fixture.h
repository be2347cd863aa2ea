#pragma once
// A small set of plug-ins with every kind of parameter, so that configs are tested without the real ones.

#include <memory>

#include "experiments/method_plan.h"

namespace gradslc::fixtures {

class FakeIntegrator final : public Integrator {
 public:
  enum class Bounding { none, clamp, compensate };

  void describe(ParameterVisitor& visitor) override {
    visitor.group("vpl", "virtual point lights", [&] {
      visitor.integer("light_paths", light_paths, at_least(1), "paths", "light paths traced for one set");
      visitor.choice("bounding", bounding, {"none", "clamp", "compensate"}, "what happens to near connections");
      visitor.real("bound", bound, at_least(0), "1/length^2", "bound of a connection");
    });
    visitor.integer("cut_size", cut_size, {1, 1024}, "nodes", "nodes of a cut");
    visitor.boolean("roulette", roulette, "whether paths may end early");
  }
  void prepare(const Scene&, const RenderSettings&) override {}
  void render_pass(std::uint32_t, Film&) override {}
  IntegratorTraits traits() const override { return {}; }
  IntegratorStatistics statistics() const override { return {}; }

  int light_paths = 10000, cut_size = 10;
  Bounding bounding = Bounding::compensate;
  float bound = 0.1f;
  bool roulette = false;
};

class FakeReconstruction final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.real("alpha", alpha, {0, 10}, "", "weight of the primal");
  }
  ReconstructionResult reconstruct(const ReconstructionInput&) const override { return {}; }

  float alpha = 0.2f;
};

class FakeNoReconstruction final : public Reconstruction {
 public:
  void describe(ParameterVisitor&) override {}
  ReconstructionResult reconstruct(const ReconstructionInput&) const override { return {}; }
};

inline Registries fake_registries() {
  static constexpr IntegratorEntry k_integrators[] = {
      {"spt", "path tracing", []() -> std::unique_ptr<Integrator> { return std::make_unique<FakeIntegrator>(); }},
      {"slc", "lightcuts", []() -> std::unique_ptr<Integrator> { return std::make_unique<FakeIntegrator>(); }}};
  static constexpr ReconstructionEntry k_reconstructions[] = {
      {"none", "the primal image",
       []() -> std::unique_ptr<Reconstruction> { return std::make_unique<FakeNoReconstruction>(); }, false},
      {"l2", "least squares",
       []() -> std::unique_ptr<Reconstruction> { return std::make_unique<FakeReconstruction>(); }, true}};
  static constexpr SamplerEntry k_samplers[] = {{"independent", SamplerKind::independent, "white noise"},
                                                {"sobol", SamplerKind::sobol, "low discrepancy"}};
  return {k_integrators, k_reconstructions, k_samplers};
}

}  // namespace gradslc::fixtures
