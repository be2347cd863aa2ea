#include "integrators/gather_effort.h"

#include <algorithm>
#include <cmath>

namespace gradslc {
namespace {

/// Sums over the pixels of a cell, or of the image.
struct PilotMoments {
  double value = 0, variance = 0;       ///< of a pass
  double by_ray = 0;                    ///< second moment
  double by_emitters = 0, by_draw = 0;  ///< variances, of one sample
  double pixels = 0;

  PilotMoments& operator+=(const PilotMoments& o) {
    value += o.value, variance += o.variance, by_ray += o.by_ray;
    by_emitters += o.by_emitters, by_draw += o.by_draw, pixels += o.pixels;
    return *this;
  }
};

/// Over the passes.
struct MeanAndVariance {
  double sum = 0, sum2 = 0;
  void add(float x) { sum += static_cast<double>(x), sum2 += static_cast<double>(x) * static_cast<double>(x); }
  double variance(double count) const { return count > 1 ? std::max(0.0, sum2 - sum * sum / count) / (count - 1) : 0; }
};

}  // namespace

EffortAllocation::EffortAllocation(Resolution resolution, const EffortParameters& parameters, int pilot_draws)
    : parameters_(parameters),
      passes_(static_cast<std::size_t>(parameters.pilot_passes)),
      cells_({(resolution.width + k_cell - 1) / k_cell, (resolution.height + k_cell - 1) / k_cell},
             GatherEffort{.draws = pilot_draws}) {
  for (Pass& pass : passes_) pass.samples = Image<Sample>(resolution);
}

void EffortAllocation::close() {
  closed_ = true;
  const Resolution resolution = passes_[0].samples.resolution();
  const auto count = static_cast<double>(passes_.size());
  const auto moments_of = [&](std::size_t pixel) {
    MeanAndVariance total, ray, emitters, draws;
    for (const Pass& pass : passes_) {
      const Sample& sample = pass.samples[pixel];
      total.add(sample.total), ray.add(sample.by_ray), emitters.add(sample.by_emitters);
      draws.add(sample.draw_variance);
    }
    return PilotMoments{.value = total.sum / count,
                        .variance = total.variance(count),
                        .by_ray = ray.sum2 / count,
                        .by_emitters = emitters.variance(count),
                        .by_draw = draws.sum / count,
                        .pixels = 1};
  };
  Image<PilotMoments> cells(cells_.resolution());
  PilotMoments image;
  for (std::size_t i = 0; i < resolution.pixels(); ++i) {
    const Pixel pixel = resolution.pixel(i);
    const PilotMoments moments = moments_of(i);
    cells[{pixel.x / k_cell, pixel.y / k_cell}] += moments;
    image += moments;
  }
  const double mean = image.value / image.pixels;
  const auto relative_to = [&](const PilotMoments& cell) {
    const double scale = cell.value / cell.pixels;
    return scale * scale + 0.01 * mean * mean;
  };
  double variance = 0;  // relative, mean over the image
  for (const PilotMoments& cell : cells)
    if (relative_to(cell) > 0) variance += cell.variance / relative_to(cell) / image.pixels;
  if (!(variance > 0)) return;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PilotMoments& cell = cells[i];
    if (!(relative_to(cell) > 0)) continue;
    const auto best = [&](double sum, float cost) {
      const double of_one = sum / cell.pixels / relative_to(cell);
      return static_cast<float>(
          std::sqrt(of_one * static_cast<double>(parameters_.pass_cost) / (static_cast<double>(cost) * variance)));
    };
    const auto rounded = [](float number, int most) {
      return static_cast<int>(std::lround(std::clamp(number, 1.0f, static_cast<float>(most))));
    };
    GatherEffort& effort = cells_[i];
    effort.rays = std::clamp(best(cell.by_ray, 1), parameters_.fewest_rays, parameters_.most_rays);
    effort.emitters = rounded(best(cell.by_emitters, parameters_.sample_cost), parameters_.most_emitter_samples);
    if (parameters_.adapt_draws)
      effort.draws = rounded(best(cell.by_draw, parameters_.sample_cost), parameters_.most_draws);
  }
}

}  // namespace gradslc
