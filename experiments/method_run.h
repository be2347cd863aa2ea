#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/clock.h"
#include "experiments/experiment.h"
#include "experiments/reconstruct.h"

namespace gradslc {

/// Where a method stood when it gave an image: a point of its convergence curve.
struct CurvePoint {
  double target = 0;   ///< passes or wall seconds that the point was planned for
  bool final = false;  ///< the whole budget
  int passes = 0;
  Seconds prepare, render;
  Seconds reconstruct;  ///< of this point alone
  /// How much longer, on the wall, the longest of the run's reconstructions takes: the budget waits for that one.
  double waited_seconds = 0;
  std::uint64_t rays = 0;
  std::uint64_t invalid_samples = 0;
  double pass_seconds = 0;  ///< predicted wall time of one more pass
  std::optional<ReconstructionStatistics> reconstruction;

  /// What the point cost: earlier points' reconstructions are not part of it.
  Seconds total() const { return prepare + render + reconstruct; }
};

/// A curve point with the image that it has, by one of the run's reconstructions.
struct PointImage {
  std::size_t reconstruction = 0;
  CurvePoint point;
  RgbImage image;
};

/// Targets of a budget's curve points, ascending, the budget last: passes 1, 2, 4, ...; or seconds budget / 2^k down to
/// 1/128 of the budget.
std::vector<double> curve_targets(const Budget& budget);

/// One method on its way through its budget (DESIGN 8). Does one unit of work at a time, so that methods can take
/// turns; its clock runs only inside step(). It may have several reconstructions of the same samples: each is charged
/// with its own time alone.
class MethodRun {
 public:
  struct Plan {
    std::string name;
    RenderSettings settings;
    Budget budget;
    FilmLayers layers;            ///< beside gradients, which are the method's own
    std::vector<double> targets;  ///< of curve points, ascending, the budget last
  };
  using Reconstructions = std::vector<std::unique_ptr<Reconstruction>>;
  /// `scene` must outlive the run. At least one reconstruction, which may be null: the primal. `clock` tells the time.
  MethodRun(Plan plan, std::unique_ptr<Integrator> integrator, Reconstructions reconstructions, const Scene& scene,
            Clock clock);

  bool done() const { return next_target_ == plan_.targets.size(); }
  /// Share of the budget that is used, in seconds or passes, at most 1; 1 when done.
  double progress() const;
  /// Prepares the method, or renders a pass, or gives the images of a curve point that is due; only while !done().
  /// A point is due when its passes are there, or when one more pass and the point's longest reconstruction, as long as
  /// earlier ones took, would end beyond its seconds. Points that cannot be given before a tenth more than their
  /// seconds have passed, or since whose predecessor no pass was rendered, are left out; the final one is not, and gets
  /// one pass at least.
  std::vector<PointImage> step();

  const std::string& name() const { return plan_.name; }
  int passes() const { return passes_; }
  Seconds prepare_time() const { return prepare_; }
  Seconds render_time() const { return render_; }
  const Film& film() const { return *film_; }  ///< only after the first step
  /// Only when done; sets that are still open are closed. Shared by all results of the run.
  std::shared_ptr<const Film> finished_film();
  IntegratorTraits traits() const { return integrator_->traits(); }
  IntegratorStatistics statistics() const { return integrator_->statistics(); }

 private:
  void prepare();
  void render_pass();
  std::vector<PointImage> make_point();
  void skip_missed_targets();
  bool point_is_due() const;
  double predicted_pass_seconds() const;
  double spent() const { return prepare_.wall + render_.wall; }
  bool is_final_target() const { return next_target_ + 1 == plan_.targets.size(); }

  Plan plan_;
  std::unique_ptr<Integrator> integrator_;
  Reconstructions reconstructions_;
  const Scene& scene_;
  Clock clock_;
  std::shared_ptr<Film> film_;  // made once the method has said whether it has gradients
  int passes_ = 0;
  Seconds prepare_, render_;
  std::vector<double> recent_pass_seconds_;  // of the last passes, a ring
  double reconstruct_seconds_ = 0;           // what the longest of the last point's took
  int last_point_passes_ = 0;
  std::size_t next_target_ = 0;
};

}  // namespace gradslc
