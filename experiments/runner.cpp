#include "experiments/runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "experiments/comparison.h"
#include "experiments/report.h"
#include "experiments/results_folder.h"
#include "experiments/scene_hash.h"
#include "experiments/sha256.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

constexpr const char* k_image_file = "image.exr";
constexpr const char* k_curve_file = "convergence.csv";

/// Tells the progress of work that comes in equal units: a reference or a comparison each.
class ProgressMeter {
 public:
  ProgressMeter(const Progress& receiver, const Clock& clock) : receiver_(receiver), clock_(clock) {
    begin_ = clock_().wall;
  }
  void expect(std::size_t units) { total_ += units; }
  void begin_unit(std::string what) { what_ = std::move(what); }
  void show(double unit_fraction) const {
    if (!receiver_ || total_ == 0) return;
    const double fraction = (static_cast<double>(done_) + unit_fraction) / static_cast<double>(total_);
    if (fraction > 0) receiver_(fraction, (clock_().wall - begin_) * (1 - fraction) / fraction, what_);
  }
  void end_unit() { ++done_; }

 private:
  const Progress& receiver_;
  const Clock& clock_;
  double begin_;
  std::size_t total_ = 0, done_ = 0;
  std::string what_;
};

RenderSettings settings_of(const Experiment& experiment, const ScenePlan& plan) {
  RenderSettings settings = experiment.settings;
  if (plan.max_depth) settings.max_depth = *plan.max_depth;
  return settings;
}

/// Makes everything once that the experiment needs, so that bad input is found before anything is written or waited
/// for.
void check_inputs(const Experiment& experiment, const Makers& makers) {
  for (const MethodPlan& method : experiment.methods) {
    makers.integrator(method);
    makers.reconstruction(method);
  }
  for (const ScenePlan& plan : experiment.scenes) {
    const Scene scene = makers.scene(plan);
    require_memory(plan_memory(experiment.methods, plan.name, scene, settings_of(experiment, plan), makers),
                   makers.available_memory());
    if (experiment.reference.kind == ReferencePlan::Kind::file) {
      imported_reference(experiment.reference.file, scene.camera().resolution());
    }
  }
}

/// An experiment on its way.
class Run {
 public:
  Run(const Experiment& experiment, const RunOptions& options, const Makers& makers)
      : experiment_(experiment),
        options_(options),
        makers_(makers),
        folder_(options.out, experiment),
        config_hash_(sha256(experiment.resolved.dump())),
        meter_(options.progress, makers.clock) {
    meter_.expect(experiment.scenes.size() * units_per_scene());
  }

  void run() {
    for (const ScenePlan& plan : experiment_.scenes) run_scene(plan);
  }

 private:
  bool has_reference() const { return experiment_.reference.kind != ReferencePlan::Kind::none; }
  std::size_t units_per_scene() const {
    return static_cast<std::size_t>(experiment_.repeats) + (has_reference() ? 1 : 0);
  }
  void log(const std::string& line) const {
    if (options_.log) options_.log(line);
  }

  void run_scene(const ScenePlan& plan) {
    const Scene scene = makers_.scene(plan);
    const std::string hash = scene_hash(scene);
    const RenderSettings settings = settings_of(experiment_, plan);
    log(fmt::format("{}: {}x{}, {} triangles", plan.name, scene.camera().resolution().width,
                    scene.camera().resolution().height, scene.triangle_count()));

    std::optional<Reference> reference;
    if (has_reference()) {
      meter_.begin_unit(plan.name + ", reference");
      if (!all_complete(plan, hash)) {
        reference = obtain_reference(
            experiment_.reference, scene, hash, settings, reference_folder(options_.out), makers_,
            [&](const std::string& line) { log(plan.name + ": " + line); },
            [&](double fraction) { meter_.show(fraction); });
      }
      meter_.end_unit();
    }
    for (int repeat = 0; repeat < experiment_.repeats; ++repeat) {
      meter_.begin_unit(fmt::format("{}, repeat {} of {}", plan.name, repeat + 1, experiment_.repeats));
      if (!keep_comparison(plan, hash, repeat)) {
        RenderSettings repeat_settings = settings;
        repeat_settings.seed = repeat_seed(settings.seed, repeat);
        const Comparison comparison{experiment_, scene, plan.name, repeat_settings, reference ? &*reference : nullptr,
                                    repeat};
        write_comparison(comparison, plan, hash);
      }
      meter_.end_unit();
      write_file_atomically(options_.out / "results.csv", to_csv(rows_));
    }
  }

  bool is_complete(const ScenePlan& plan, const std::string& hash, int repeat) const {
    return std::all_of(experiment_.methods.begin(), experiment_.methods.end(), [&](const MethodPlan& method) {
      return folder_.complete_run(plan.name, hash, method.name, repeat).has_value();
    });
  }
  bool all_complete(const ScenePlan& plan, const std::string& hash) const {
    for (int repeat = 0; repeat < experiment_.repeats; ++repeat) {
      if (!is_complete(plan, hash, repeat)) return false;
    }
    return true;
  }

  /// Takes over the rows of a comparison that is complete already; false where it is not.
  bool keep_comparison(const ScenePlan& plan, const std::string& hash, int repeat) {
    if (!is_complete(plan, hash, repeat)) return false;
    for (const MethodPlan& method : experiment_.methods) {
      add_rows(*folder_.complete_run(plan.name, hash, method.name, repeat));
    }
    log(fmt::format("{}: repeat {} of {} is complete, kept", plan.name, repeat + 1, experiment_.repeats));
    return true;
  }

  void write_comparison(const Comparison& comparison, const ScenePlan& plan, const std::string& hash) {
    const std::vector<ComparedMethod> methods =
        run_comparison(comparison, makers_, [&](double fraction) { meter_.show(fraction); });
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const MethodPlan& method = experiment_.methods[i];
      const std::filesystem::path folder = folder_.run_folder(plan.name, method.name, comparison.repeat);
      std::filesystem::remove((folder / k_image_file).replace_extension(".json"));  // of a run that was not kept
      write_file_atomically(folder / k_curve_file, to_csv(methods[i].rows));
      write_render(folder / k_image_file, methods[i].result, manifest(comparison, plan, hash, method));
      log_result(methods[i].rows.back());
      add_rows(methods[i].rows);
    }
  }

  nlohmann::json manifest(const Comparison& comparison, const ScenePlan& plan, const std::string& hash,
                          const MethodPlan& method) const {
    const Budget& budget = experiment_.budget;
    return {{"experiment", experiment_.name},
            {"config", experiment_.resolved},
            {"config_sha256", config_hash_},
            {"scene",
             {{"name", plan.name},
              {"file", plan.file.string()},
              {"file_sha256", sha256_of_file(plan.file)},
              {"content_sha256", hash},
              {"triangles", comparison.scene.triangle_count()}}},
            {"method", to_json(method)},
            {"settings", to_json(comparison.settings)},
            {"parts", experiment_.parts},
            {"debug", experiment_.debug},
            {"repeat", comparison.repeat},
            {"budget", {{budget.kind == Budget::Kind::spp ? "spp" : "seconds", budget.value}}},
            {"reference", comparison.reference != nullptr ? comparison.reference->about : nlohmann::json(nullptr)}};
  }

  void log_result(const ResultRow& row) const {
    std::string line = fmt::format("{}: {}, repeat {}: {} passes, {:.3g} s", row.scene, row.method, row.repeat + 1,
                                   row.passes, row.wall_seconds);
    if (const std::optional<double> relmse = row.metric("relmse")) line += fmt::format(", relmse {:.4g}", *relmse);
    for (const std::string& flag : row.flags) line += ", " + flag;
    log(line);
  }

  void add_rows(const std::vector<ResultRow>& rows) { rows_.insert(rows_.end(), rows.begin(), rows.end()); }

  const Experiment& experiment_;
  const RunOptions& options_;
  const Makers& makers_;
  ResultsFolder folder_;
  std::string config_hash_;
  ProgressMeter meter_;
  std::vector<ResultRow> rows_;
};

}  // namespace

std::uint64_t repeat_seed(std::uint64_t experiment_seed, int repeat) {
  return hash_combine(experiment_seed, static_cast<std::uint64_t>(repeat));
}

std::vector<PlannedRun> plan_experiment(const Experiment& experiment, const Makers& makers) {
  std::vector<PlannedRun> runs;
  for (const ScenePlan& plan : experiment.scenes) {
    const std::vector<PlannedRun> of_scene =
        plan_memory(experiment.methods, plan.name, makers.scene(plan), settings_of(experiment, plan), makers);
    runs.insert(runs.end(), of_scene.begin(), of_scene.end());
  }
  return runs;
}

void run_experiment(const Experiment& experiment, const RunOptions& options) {
  run_experiment(experiment, options, real_makers());
}

void run_experiment(const Experiment& experiment, const RunOptions& options, const Makers& makers) {
  check_inputs(experiment, makers);
  Run(experiment, options, makers).run();
  write_report(options.out);
}

}  // namespace gradslc
