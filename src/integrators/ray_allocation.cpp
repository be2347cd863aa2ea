#include "integrators/ray_allocation.h"

#include <algorithm>
#include <cmath>

namespace gradslc {

RayAllocation::RayAllocation(Resolution resolution, const RayAllocationParameters& parameters)
    : parameters_(parameters),
      passes_(static_cast<std::size_t>(parameters.pilot_passes)),
      cells_({(resolution.width + k_cell - 1) / k_cell, (resolution.height + k_cell - 1) / k_cell}, 1) {
  for (Pass& pass : passes_) pass.samples = Image<Sample>(resolution);
}

void RayAllocation::close() {
  closed_ = true;
  const Resolution resolution = passes_[0].samples.resolution();
  const auto count = static_cast<double>(passes_.size());
  struct Moments {
    double value = 0, brought2 = 0, variance = 0, pixels = 0;
  };
  Image<Moments> cells(cells_.resolution());
  Moments image;
  for (std::size_t i = 0; i < resolution.pixels(); ++i) {
    double sum = 0, sum2 = 0, brought2 = 0;
    for (const Pass& pass : passes_) {
      const double value = static_cast<double>(pass.samples[i].total);
      const double brought = static_cast<double>(pass.samples[i].brought);
      sum += value, sum2 += value * value, brought2 += brought * brought;
    }
    const Pixel pixel = resolution.pixel(i);
    for (Moments* m : {&cells[{pixel.x / k_cell, pixel.y / k_cell}], &image}) {
      m->value += sum / count, m->brought2 += brought2 / count, m->pixels += 1;
      if (passes_.size() > 1) m->variance += std::max(0.0, sum2 - sum * sum / count) / (count - 1);
    }
  }
  const double mean = image.value / image.pixels;
  const auto relative_to = [&](const Moments& cell) {
    const double scale = cell.value / cell.pixels;
    return scale * scale + 0.01 * mean * mean;
  };
  double variance = 0;  // relative, mean over the image
  for (const Moments& cell : cells)
    if (relative_to(cell) > 0) variance += cell.variance / relative_to(cell) / image.pixels;
  if (!(variance > 0)) return;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!(relative_to(cells[i]) > 0)) continue;
    const double moment = cells[i].brought2 / cells[i].pixels / relative_to(cells[i]);
    const double best = std::sqrt(moment * static_cast<double>(parameters_.pass_cost) / variance);
    cells_[i] = std::clamp(static_cast<float>(best), parameters_.fewest, parameters_.most);
  }
}

}  // namespace gradslc
