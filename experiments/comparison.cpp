#include "experiments/comparison.h"

#include <cmath>

#include "experiments/build_info.h"
#include "experiments/turns.h"
#include "experiments/vpl_light.h"

namespace gradslc {
namespace {

constexpr double k_budget_tolerance = 0.02;      // of the budget; or one pass, where that is longer
constexpr double k_trusted_above_reference = 3;  // times the reference's own relmse

void add_errors(ResultRow& row, const PointImage& point, const Film& film, const Reference& reference) {
  row.metrics = compare_images(point.image, reference.images);
  row.reference_noise = reference.noise;
  if (point.point.reconstruction) {
    row.primal_relmse = metric_value(compare_images(film.primal(), reference.images), "relmse");
  }
  // Parts are the primal's: what reconstruction does to them is not known.
  if (reference.vpl_light && film.layers().parts && !point.point.reconstruction) {
    const std::vector<Metric> errors = compare_images(vpl_light(film), *reference.vpl_light);
    row.vpl_light_relmse = metric_value(errors, "relmse");
    row.vpl_light_relmse_trimmed = metric_value(errors, "relmse_trimmed");
  }
  if (!reference.noise)
    row.flags.push_back("imported_reference");
  else if (row.metric("relmse") < k_trusted_above_reference * *reference.noise) {
    row.flags.push_back("near_reference_noise");
  }
}

void add_trait_flags(ResultRow& row, const IntegratorTraits& traits) {
  if (traits.biased) row.flags.push_back("biased");
  if (traits.truncated) row.flags.push_back("truncated");
  if (traits.one_set) row.flags.push_back("one_set");
}

/// What renders, and the methods of the experiment that its reconstructions are.
struct Rendering {
  std::vector<MethodRun> runs;
  std::vector<std::vector<std::size_t>> methods;  ///< by run and reconstruction
};

Rendering make_rendering(const Comparison& comparison, const Makers& makers) {
  const Experiment& experiment = comparison.experiment;
  Rendering rendering;
  for (const MethodPlan& leader : experiment.methods) {
    if (!leader.render_of.empty()) continue;
    MethodRun::Reconstructions reconstructions;
    std::vector<std::size_t>& methods = rendering.methods.emplace_back();
    for (std::size_t i = 0; i < experiment.methods.size(); ++i) {
      const MethodPlan& method = experiment.methods[i];
      if (method.name != leader.name && method.render_of != leader.name) continue;
      methods.push_back(i);
      reconstructions.push_back(makers.reconstruction(method));
    }
    MethodRun::Plan plan{leader.name, comparison.settings, experiment.budget,
                         FilmLayers{.parts = experiment.parts, .debug = experiment.debug},
                         curve_targets(experiment.budget)};
    rendering.runs.emplace_back(std::move(plan), makers.integrator(leader), std::move(reconstructions),
                                comparison.scene, makers.clock);
  }
  return rendering;
}

}  // namespace

ResultRow make_row(const CurvePoint& point, const Budget& budget) {
  ResultRow row;
  row.passes = point.passes;
  row.wall_seconds = point.total().wall;
  row.cpu_seconds = point.total().cpu;
  row.prepare_seconds = point.prepare.wall;
  row.render_seconds = point.render.wall;
  row.reconstruct_seconds = point.reconstruct.wall;
  row.rays = point.rays;
  row.target = point.target;
  row.final = point.final;
  if (point.final && budget.kind == Budget::Kind::seconds) {
    row.budget_miss = row.wall_seconds / budget.value - 1;
    const double allowed = std::max(k_budget_tolerance * budget.value, point.pass_seconds) + point.waited_seconds;
    if (std::abs(row.wall_seconds - budget.value) > allowed) row.flags.push_back("budget_missed");
  }
  if (point.invalid_samples > 0) row.flags.push_back("invalid_samples");
  if (point.reconstruction && !point.reconstruction->converged) row.flags.push_back("not_converged");
  return row;
}

std::vector<ComparedMethod> run_comparison(const Comparison& comparison, const Makers& makers,
                                           const std::function<void(double)>& progress) {
  const Experiment& experiment = comparison.experiment;
  const nlohmann::json machine = machine_info();
  Rendering rendering = make_rendering(comparison, makers);
  std::vector<ComparedMethod> methods(experiment.methods.size());

  const auto receive = [&](std::size_t run_index, PointImage point) {
    MethodRun& run = rendering.runs[run_index];
    const std::size_t i = rendering.methods[run_index][point.reconstruction];
    ResultRow row = make_row(point.point, experiment.budget);
    row.scene = comparison.scene_name;
    row.method = experiment.methods[i].name;
    row.repeat = comparison.repeat;
    add_trait_flags(row, run.traits());
    if (comparison.reference != nullptr) add_errors(row, point, run.film(), *comparison.reference);
    methods[i].rows.push_back(std::move(row));
    if (point.point.final) methods[i].result = take_result(run, std::move(point), machine);
  };
  take_turns(rendering.runs, static_cast<std::size_t>(comparison.repeat), receive, progress);
  return methods;
}

}  // namespace gradslc
