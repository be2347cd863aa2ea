#include "film/debug_image.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace gradslc {

void Largest::raise(const Largest& other) {
  const float value = std::isfinite(other.luminance) ? other.luminance : std::numeric_limits<float>::infinity();
  if (value > luminance || (value > 0 && value == luminance && other.pass < pass)) {
    *this = other;
    luminance = value;
  }
}

void DebugImage::Accumulator::merge(const Accumulator& other) {
  cut_size += other.cut_size, node_evaluations += other.node_evaluations, rays += other.rays;
  failed_shifts += other.failed_shifts;
  samples += other.samples;
  contribution.raise(other.contribution);
  sample.raise(other.sample);
}

void DebugImage::add(Pixel pixel, const DebugSample& sample) {
  pixels_[pixel].merge({static_cast<double>(sample.cut_size),
                        static_cast<double>(sample.node_evaluations),
                        static_cast<double>(sample.rays),
                        static_cast<double>(sample.failed_shifts),
                        1,
                        sample.contribution,
                        {luminance(sample.value), sample.pass, std::nullopt}});
}

void DebugImage::merge(const DebugImage& other) {
  assert(resolution() == other.resolution());
  for (std::size_t i = 0; i < pixels_.size(); ++i) pixels_[i].merge(other.pixels_[i]);
}

std::optional<Pixel> pixel_of_largest_contribution(const DebugImage& image) {
  std::optional<Pixel> found;
  float most = 0;
  for (std::size_t i = 0; i < image.resolution().pixels(); ++i) {
    if (image[i].contribution.luminance <= most) continue;
    most = image[i].contribution.luminance;
    found = image.resolution().pixel(i);
  }
  return found;
}

}  // namespace gradslc
