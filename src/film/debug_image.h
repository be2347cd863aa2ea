#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "film/part.h"

namespace gradslc {

/// The largest of some luminances, and the pass that it is from. What is not finite counts as infinite, so that it is
/// found, too.
struct Largest {
  float luminance = 0;
  std::int64_t pass = -1;    ///< -1: there was none above 0
  std::optional<Part> part;  ///< of a contribution, where it is known

  /// Becomes `other` where that is larger, or as large and from an earlier pass.
  void raise(const Largest& other);
  bool operator==(const Largest&) const = default;
};

/// What one sample of a pixel has cost, and its largest contribution: one connection with a VPL, one next-event
/// estimate or one emitter that was hit, as much of it as the sample holds.
struct DebugSample {
  std::uint32_t pass = 0;
  float cut_size = 0;          ///< clusters or VPLs that stood for all VPLs
  float node_evaluations = 0;  ///< of the light tree; of a group's, the pixel's share
  std::uint64_t rays = 0;
  std::uint32_t failed_shifts = 0;  ///< offset paths that ended before the base path
  Largest contribution;
  Rgb value;
};

/// Where a method spends its time and where fireflies come from, pixel by pixel.
class DebugImage {
 public:
  DebugImage() = default;
  explicit DebugImage(Resolution resolution) : pixels_(resolution) {}

  bool empty() const { return pixels_.empty(); }
  Resolution resolution() const { return pixels_.resolution(); }
  /// Different pixels may be added to concurrently.
  void add(Pixel pixel, const DebugSample& sample);
  void merge(const DebugImage& other);

  /// One pixel's samples: sums and largest.
  struct Accumulator {
    double cut_size = 0, node_evaluations = 0, rays = 0, failed_shifts = 0;
    std::uint32_t samples = 0;  ///< those that were not finite included
    Largest contribution, sample;

    void merge(const Accumulator& other);
    bool operator==(const Accumulator&) const = default;
  };
  const Accumulator& operator[](std::size_t index) const { return pixels_[index]; }
  const Accumulator& operator[](Pixel pixel) const { return pixels_[pixel]; }

 private:
  Image<Accumulator> pixels_;
};

/// The pixel with the largest contribution, the first in reading order; nullopt where no pixel has any.
std::optional<Pixel> pixel_of_largest_contribution(const DebugImage& image);

}  // namespace gradslc
