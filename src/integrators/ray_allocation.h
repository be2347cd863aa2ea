#pragma once

#include <vector>

#include "core/image.h"
#include "core/parameters.h"

namespace gradslc {

/// How many rays through f_c(x) a gather sends (DESIGN 4: the ray that compensates bounding).
struct RayAllocationParameters {
  int pilot_passes = 4;
  float pass_cost = 5, fewest = 0.25f, most = 8;
};

inline void describe(ParameterVisitor& v, RayAllocationParameters& p) {
  v.integer(
      "pilot_passes", p.pilot_passes, {0, 1000}, "passes",
      "first passes, with one ray a gather, from which the number of rays in later ones is found; below 2: always one");
  v.real("pass_cost", p.pass_cost, {1e-3, 1e3}, "rays", "time of a whole pass without these rays, in their time");
  v.real("fewest", p.fewest, {1e-3, 1}, "rays", "least mean number of rays of a gather");
  v.real("most", p.most, {1, 1e3}, "rays", "most rays of a gather");
}

/// Finds the numbers that give the least error for the time: a pass of relative variance V and cost C in units of rays,
/// whose rays of relative second moment m in a cell of 8 x 8 pixels are sent n times, has an error x time of
/// (V + mean(m / n)) (C + mean(n)), least for n = sqrt(m C / V) cell by cell. Relative: to I^2 + 0.01 mean(I)^2. The
/// numbers are a function of the pilot passes alone, so that any later pass can be rendered again by itself. One ray
/// where pilots show no variance, as one pass alone never does.
class RayAllocation {
 public:
  /// At least one pilot pass.
  RayAllocation(Resolution resolution, const RayAllocationParameters& parameters);

  /// One sample of a pilot pass: luminance of the pixel, and of what its one ray brought. From any thread.
  void add(int pass, Pixel pixel, float total, float brought) {
    passes_[static_cast<std::size_t>(pass)].samples[pixel] = {total, brought};
  }
  void finish_pass(int pass) { passes_[static_cast<std::size_t>(pass)].finished = true; }
  bool has_pass(int pass) const { return passes_[static_cast<std::size_t>(pass)].finished; }
  /// When all pilot passes are finished; then rays() is valid.
  void close();
  bool closed() const { return closed_; }
  /// Mean number of rays of a gather, > 0.
  float rays(Pixel pixel) const { return cells_[{pixel.x / k_cell, pixel.y / k_cell}]; }

 private:
  static constexpr int k_cell = 8;
  struct Sample {
    float total = 0, brought = 0;
  };
  struct Pass {
    Image<Sample> samples;
    bool finished = false;
  };
  RayAllocationParameters parameters_;
  std::vector<Pass> passes_;
  Image<float> cells_;
  bool closed_ = false;
};

}  // namespace gradslc
