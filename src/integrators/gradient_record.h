#pragma once

#include <vector>

#include "integrators/record.h"
#include "shifts/block_partition.h"
#include "shifts/stencil.h"

namespace gradslc {

/// Differences of all neighbours within a block. `value`(i): of its i-th pixel.
template <class Value>
void record_differences(const BlockPartition::Block& block, FilmHalf& half, const Value& value) {
  const auto& [first, size] = block;
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const Pixel local = size.pixel(i), right{local.x + 1, local.y}, lower{local.x, local.y + 1};
    if (size.contains(right)) half.dx.add(first + local, value(size.index(right)) - value(i));
    if (size.contains(lower)) half.dy.add(first + local, value(size.index(lower)) - value(i));
  }
}

/// The values of all groups of a base pixel and its offsets in a pass, and what the film gets of them: a pixel's primal
/// is the mean over all groups that hold it; a difference the mean over those that hold both pixels.
class StencilValues {
 public:
  void begin(Resolution resolution, Stencil stencil, bool logged);
  /// Of the k-th pixel of a base's stencil. From any thread.
  PartValues& value(Pixel base, std::size_t k) { return values_[index(base, k)]; }
  /// That value's log, begun; null where none is wanted.
  PathLog* begin_log(const LoggedSamples& logged, Pixel base, std::size_t k);
  /// The log of what a pixel's groups share.
  PathLog* begin_prefix_log(const LoggedSamples& logged, Pixel pixel);
  void record(const LoggedSamples& logged, FilmHalf& half, bool gradients) const;

 private:
  std::size_t index(Pixel base, std::size_t k) const { return resolution_.index(base) * offsets_.size() + k; }
  Rgb total(Pixel base, std::size_t k) const { return values_[index(base, k)].total(); }
  void record_primal(Pixel pixel, const LoggedSamples& logged, FilmHalf& half) const;
  void record_difference(Pixel pixel, Pixel step, std::size_t forward, std::size_t backward,
                         MomentImage& moments) const;

  Resolution resolution_;
  std::span<const Pixel> offsets_;
  std::vector<PartValues> values_;  // per base pixel and offset
  std::vector<PathLog> logs_, prefix_logs_;
};

}  // namespace gradslc
