#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/hash.h"
#include "core/parameters.h"
#include "film/film.h"
#include "integrators/integrator.h"

namespace gradslc {

/// How many samples of each kind a gather takes (DESIGN 4 and 5).
struct GatherEffort {
  float rays = 1;    ///< mean number of rays through f_c(x), > 0: rounded at random
  int emitters = 1;  ///< estimates of light from emitters by next-event estimation, >= 1
  int draws = 1;     ///< VPLs drawn among candidates, >= 1
};

struct EffortParameters {
  int pilot_passes = 4;
  float pass_cost = 5, sample_cost = 0.2f, fewest_rays = 0.25f, most_rays = 8;
  int most_emitter_samples = 8, most_draws = 40;
  bool adapt_draws = true;
};

inline void describe(ParameterVisitor& v, EffortParameters& p) {
  v.integer("pilot_passes", p.pilot_passes, {0, 1000}, "passes",
            "first passes, all gathers alike, from which the numbers in later ones are found; below 2: always alike");
  v.real("pass_cost", p.pass_cost, {1e-3, 1e3}, "rays", "time of a whole pass, in the time of a ray through f_c(x)");
  v.real("sample_cost", p.sample_cost, {1e-3, 1e3}, "rays",
         "time of a VPL's draw or a next-event estimate, in the time of such a ray");
  v.real("fewest_rays", p.fewest_rays, {1e-3, 1}, "rays", "least mean number of rays of a gather");
  v.real("most_rays", p.most_rays, {1, 1e3}, "rays", "most rays of a gather");
  v.integer("most_emitter_samples", p.most_emitter_samples, {1, 1000}, "estimates",
            "most next-event estimates of a gather");
  v.integer("most_draws", p.most_draws, {1, 65536}, "VPLs", "most VPLs that a gather draws");
  v.boolean("adapt_draws", p.adapt_draws, "false: every gather draws as many VPLs as the pilots do");
}

/// Finds the numbers that give the least error for the time. A pass has the relative variance V and the cost C in units
/// of rays. In a cell of 8 x 8 pixels samples of one kind, of cost c each, have relative variance v for one of them: of
/// n they leave v / n. Error x time, (V + mean(v / n)) (C + mean(c n)), is least for n = sqrt(v C / (c V)), kind by
/// kind and cell by cell. Relative: to I^2 + 0.01 mean(I)^2. Rays count by their second moment, since their number may
/// be 0. The numbers are a function of the pilot passes alone, so that any later pass can be rendered again by itself.
/// As in pilots where these show no variance, as one pass alone never does.
class EffortAllocation {
 public:
  /// One sample of a pilot pass, made with one ray and one next-event estimate; luminances.
  struct Sample {
    float total = 0;          ///< of the pixel
    float by_ray = 0;         ///< brought by the ray
    float by_emitters = 0;    ///< brought by next-event estimation
    float draw_variance = 0;  ///< of the light from VPLs, if a single one were drawn
  };

  /// At least one pilot pass, in which gathers drew `pilot_draws` VPLs.
  EffortAllocation(Resolution resolution, const EffortParameters& parameters, int pilot_draws);

  /// From any thread.
  void add(int pass, Pixel pixel, const Sample& sample) {
    passes_[static_cast<std::size_t>(pass)].samples[pixel] = sample;
  }
  void finish_pass(int pass) { passes_[static_cast<std::size_t>(pass)].finished = true; }
  bool has_pass(int pass) const { return passes_[static_cast<std::size_t>(pass)].finished; }
  /// When all pilot passes are finished; then effort() is valid.
  void close();
  bool closed() const { return closed_; }
  const GatherEffort& effort(Pixel pixel) const { return cells_[{pixel.x / k_cell, pixel.y / k_cell}]; }

 private:
  static constexpr int k_cell = 8;
  struct Pass {
    Image<Sample> samples;
    bool finished = false;
  };
  EffortParameters parameters_;
  std::vector<Pass> passes_;
  Image<GatherEffort> cells_;
  bool closed_ = false;
};

/// What one pass is rendered with.
struct EffortPlan {
  SeedPurpose camera = SeedPurpose::camera;      ///< adapted passes are independent of the pilots
  GatherEffort alike;                            ///< of all gathers, unless there is an allocation
  const EffortAllocation* allocation = nullptr;  ///< closed
  EffortAllocation* pilot_of = nullptr;          ///< wants to know what the pass saw
  int pilot = 0;

  GatherEffort effort(Pixel pixel) const { return allocation ? allocation->effort(pixel) : alike; }
  void note(Pixel pixel, const EffortAllocation::Sample& sample) const {
    if (pilot_of) pilot_of->add(pilot, pixel, sample);
  }
};

/// Renders the pilot passes of a method before the first pass that depends on them.
class AdaptedEffort {
 public:
  void describe(ParameterVisitor& v) { gradslc::describe(v, parameters_); }
  void reset() { allocation_.reset(); }

  /// Calls `render`(pass, plan, film), for pilots that this run has left out with a film that is thrown away. Gathers
  /// of pilot passes draw `draws` VPLs.
  template <class Render>
  void render_pass(std::uint32_t pass, Film& film, int draws, const Render& render) {
    const GatherEffort alike{.draws = draws};
    if (parameters_.pilot_passes == 0) return render(pass, EffortPlan{.alike = alike}, film);
    if (!allocation_) allocation_.emplace(film.resolution(), parameters_, draws);
    const auto render_pilot = [&](int pilot, Film& target) {
      render(static_cast<std::uint32_t>(pilot), EffortPlan{.alike = alike, .pilot_of = &*allocation_, .pilot = pilot},
             target);
      allocation_->finish_pass(pilot);
    };
    if (pass < static_cast<std::uint32_t>(parameters_.pilot_passes)) return render_pilot(static_cast<int>(pass), film);
    for (int pilot = 0; pilot < parameters_.pilot_passes; ++pilot) {
      if (allocation_->has_pass(pilot)) continue;
      Film unused(film.resolution(), {});
      render_pilot(pilot, unused);
    }
    if (!allocation_->closed()) allocation_->close();
    render(pass, EffortPlan{.camera = SeedPurpose::adapted_camera, .allocation = &*allocation_}, film);
  }

 private:
  EffortParameters parameters_;
  std::optional<EffortAllocation> allocation_;
};

}  // namespace gradslc
