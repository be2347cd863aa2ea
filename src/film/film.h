#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace gradslc {

/// How light came to the camera (DESIGN 4): the parts of an image, which sum to it.
enum class Part : std::uint8_t { direct, vpl, compensation, specular, prefix };
constexpr int k_part_count = 5;
constexpr const char* k_part_names[k_part_count] = {"direct", "vpl", "compensation", "specular", "prefix"};

/// Count, sum and sum of squares per pixel and channel, in double. Samples come in sets (one VPL set; one pass where a
/// method has none): samples of a set are correlated, so a moment is the mean over one set. Merges exactly.
class MomentImage {
 public:
  MomentImage() = default;
  explicit MomentImage(Resolution resolution);

  Resolution resolution() const { return resolution_; }
  /// Adds a sample to the set that is open. Different pixels may be added to concurrently. A sample that is NaN or
  /// infinite is counted in invalid() and otherwise left out.
  void add(Pixel pixel, Rgb value);
  /// Ends the open set: its mean becomes one moment sample of every pixel that it has samples for.
  void close_set();
  /// Adds all of `other`, whose sets must be closed, and so must this one's.
  void merge(const MomentImage& other);

  std::uint32_t count(Pixel pixel) const;    ///< samples, those of the open set included
  std::uint32_t sets(Pixel pixel) const;     ///< closed sets that had samples here
  std::uint32_t invalid(Pixel pixel) const;  ///< NaN and infinite samples
  Rgb mean(Pixel pixel) const;               ///< over all samples, the open set included; 0 without samples
  /// Variance of mean() per channel, estimated from the scatter between closed sets; infinite with fewer than two.
  Rgb variance_of_mean(Pixel pixel) const;

  struct Accumulator {  ///< one pixel's state
    double sum[3] = {}, open_sum[3] = {}, square_sum[3] = {};  ///< square_sum: over closed sets, (set sum)^2 / set count
    std::uint32_t count = 0, open_count = 0, sets = 0, invalid = 0;
  };
  const std::vector<Accumulator>& accumulators() const { return pixels_; }
  std::vector<Accumulator>& accumulators() { return pixels_; }

 private:
  Resolution resolution_;
  std::vector<Accumulator> pixels_;
};

/// What a film records besides the primal image.
struct FilmLayers {
  bool gradients = false;
  bool parts = false;
};

/// One of the two half-buffers.
struct FilmHalf {
  MomentImage primal;
  MomentImage dx, dy;                 ///< dx(x,y) estimates I(x+1,y) - I(x,y), dy alike; empty without gradients
  std::vector<Image<Rgb>> part_sums;  ///< per Part, sum over samples, float; empty without parts
};

/// Accumulates passes of one method into two half-buffers that alternate by VPL set (by pass where there is none) and
/// are independent of each other.
class Film {
 public:
  Film(Resolution resolution, FilmLayers layers);

  Resolution resolution() const { return halves_[0].primal.resolution(); }
  FilmLayers layers() const { return layers_; }
  /// The half that samples go to: 0 or 1. Closes no set.
  FilmHalf& half(int index) { return halves_[index]; }
  const FilmHalf& half(int index) const { return halves_[index]; }
  /// Ends the open set of primal, dx and dy of a half.
  void close_set(int half_index);
  void merge(const Film& other);

  // Both halves together, weighted by their counts.
  Image<Rgb> primal() const;
  Image<Rgb> part(Part part) const;
  std::uint64_t invalid_samples() const;

 private:
  FilmLayers layers_;
  FilmHalf halves_[2];
};

}  // namespace gradslc
