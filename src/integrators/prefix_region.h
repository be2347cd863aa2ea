#pragma once

#include <algorithm>
#include <vector>

#include "integrators/camera_prefix.h"
#include "integrators/pass_schedule.h"

namespace gradslc {

/// The camera prefixes of a rectangle of pixels, all made with the same random numbers (DESIGN 6). Keeps its memory
/// from region to region.
class PrefixRegion {
 public:
  /// Traces them for the pixels of `size` from `first` of which `wanted`(pixel); others have none. `context`: with
  /// these random numbers, without rays. `jitter`: film position within each pixel. `sink`(pixel): where features go.
  template <class Wanted, class Sink>
  void trace(const PathContext& context, Vec2 jitter, Pixel first, Resolution size, const LoggedSamples& logged,
             const Wanted& wanted, const Sink& sink) {
    first_ = first, size_ = size;
    prefixes_.clear();
    if (logged.any()) logs_.resize(std::max(logs_.size(), size.pixels()));
    rays_ = 0;
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      const Pixel pixel = first + size.pixel(i);
      if (!wanted(pixel)) {
        prefixes_.emplace_back();
        continue;
      }
      PathContext path = context;
      if (logged.any()) path.log = logged.begin_part(pixel, logs_[i]);
      path.features = sink(pixel);
      prefixes_.push_back(trace_camera_prefix(path, film_position(pixel, jitter)));
      if (path.log) path.log->add_rays(path.rays);
      rays_ += path.rays;
    }
  }

  bool contains(Pixel pixel) const { return size_.contains({pixel.x - first_.x, pixel.y - first_.y}); }
  const CameraPrefix& operator[](Pixel pixel) const { return prefixes_[index(pixel)]; }
  /// Only where samples are logged.
  const PathLog& log(Pixel pixel) const { return logs_[index(pixel)]; }
  const std::vector<CameraPrefix>& prefixes() const { return prefixes_; }
  std::uint64_t rays() const { return rays_; }

 private:
  std::size_t index(Pixel pixel) const { return size_.index({pixel.x - first_.x, pixel.y - first_.y}); }

  Pixel first_;
  Resolution size_;
  std::vector<CameraPrefix> prefixes_;
  std::vector<PathLog> logs_;
  std::uint64_t rays_ = 0;
};

}  // namespace gradslc
