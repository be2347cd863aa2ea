#pragma once

#include <cstdint>

#include "core/image.h"
#include "core/parameters.h"

namespace gradslc {

/// How many rays through f_c(x) a gather sends (DESIGN 4: the ray that compensates bounding).
struct RayAllocationParameters {
  int pilot_passes = 4;
  float pass_cost = 5, fewest = 0.25f, most = 8;
};

inline void describe(ParameterVisitor& v, RayAllocationParameters& p) {
  v.integer("pilot_passes", p.pilot_passes, {0, 1000}, "passes",
            "first passes, with one ray a gather, from which the number of rays in later ones is found; 0: always one");
  v.real("pass_cost", p.pass_cost, {1e-3, 1e3}, "rays", "time of a whole pass without these rays, in their time");
  v.real("fewest", p.fewest, {1e-3, 1}, "rays", "least mean number of rays of a gather");
  v.real("most", p.most, {1, 1e3}, "rays", "most rays of a gather");
}

/// Finds the numbers that give the least error for the time: a pass of relative variance V and cost C in units of rays,
/// whose rays of relative second moment m in a cell of 8 x 8 pixels are sent n times, has an error x time of
/// (V + mean(m / n)) (C + mean(n)), least for n = sqrt(m C / V) cell by cell. Relative: to I^2 + 0.01 mean(I)^2.
class RayAllocation {
 public:
  explicit RayAllocation(Resolution resolution) : pixels_(resolution) {}

  /// One sample of a pilot pass: luminance of the pixel, and of what its ray brought. Pixels may come from any thread.
  void add(Pixel pixel, float total, float brought) {
    PixelSums& sums = pixels_[pixel];
    const double value = static_cast<double>(total), ray = static_cast<double>(brought);
    sums.total += value, sums.total2 += value * value, sums.ray2 += ray * ray, ++sums.count;
  }
  /// After the pilot passes, once.
  void close(const RayAllocationParameters& parameters);
  /// Mean number of rays of a gather, > 0.
  float rays(Pixel pixel) const { return cells_[{pixel.x / k_cell, pixel.y / k_cell}]; }

 private:
  static constexpr int k_cell = 8;
  struct PixelSums {
    double total = 0, total2 = 0, ray2 = 0;
    std::uint32_t count = 0;
  };
  Image<PixelSums> pixels_;
  Image<float> cells_;
};

}  // namespace gradslc
