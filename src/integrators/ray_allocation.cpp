#include "integrators/ray_allocation.h"

#include <algorithm>
#include <cmath>

namespace gradslc {

void RayAllocation::close(const RayAllocationParameters& parameters) {
  const Resolution resolution = pixels_.resolution();
  struct CellSums {
    double total = 0, ray2 = 0, samples = 0;
  };
  Image<CellSums> sums({(resolution.width + k_cell - 1) / k_cell, (resolution.height + k_cell - 1) / k_cell});
  CellSums image;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel pixel = resolution.pixel(i);
    for (CellSums* s : {&sums[{pixel.x / k_cell, pixel.y / k_cell}], &image})
      s->total += pixels_[i].total, s->ray2 += pixels_[i].ray2, s->samples += pixels_[i].count;
  }
  cells_ = Image<float>(sums.resolution(), 1);
  if (image.samples == 0) return;
  const double mean = image.total / image.samples, floor = 0.01 * mean * mean;

  double variance = 0;  // relative, of a sample, mean over pixels
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const PixelSums& p = pixels_[i];
    if (p.count < 2) continue;
    const Pixel pixel = resolution.pixel(i);
    const CellSums& cell = sums[{pixel.x / k_cell, pixel.y / k_cell}];
    const double scale = cell.total / cell.samples;
    const double pixel_variance = std::max(0.0, p.total2 - p.total * p.total / p.count) / (p.count - 1);
    const double relative_to = scale * scale + floor;
    if (relative_to > 0) variance += pixel_variance / relative_to / static_cast<double>(pixels_.size());
  }
  if (!(variance > 0)) return;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const CellSums& cell = sums[i];
    if (cell.samples == 0) continue;
    const double scale = cell.total / cell.samples, relative_to = scale * scale + floor;
    const double moment = relative_to > 0 ? cell.ray2 / cell.samples / relative_to : 0;
    cells_[i] = std::clamp(static_cast<float>(std::sqrt(static_cast<double>(parameters.pass_cost) * moment / variance)),
                           parameters.fewest, parameters.most);
  }
}

}  // namespace gradslc
