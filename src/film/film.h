#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "film/debug_image.h"
#include "film/feature_image.h"
#include "film/part.h"

namespace gradslc {

/// Count, sum and sum of squares per pixel and channel, in double. Samples come in sets (one VPL set; one pass where a
/// method has none): samples of a set are correlated, so a moment is the mean over one set.
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
  /// Adds all of `other`, whose sets must be closed, and so must this one's. The moments are those of all samples
  /// together: no approximation, only double's rounding, which depends on the order of merging.
  void merge(const MomentImage& other);

  /// One pixel's state.
  struct Accumulator {
    std::array<double, 3> sum = {}, open_sum = {};
    std::array<double, 3> square_sum = {};  ///< over closed sets, (set sum)^2 / set count
    std::uint32_t count = 0, open_count = 0, sets = 0, invalid = 0;

    void add(Rgb value);
    void close_set();
    void merge(const Accumulator& other);  ///< open sets become one
    Rgb mean() const;
    Rgb variance_of_mean() const;
    bool operator==(const Accumulator&) const = default;
  };

  /// Samples, those of the open set included.
  std::uint32_t count(Pixel pixel) const { return (*this)[pixel].count; }
  /// Closed sets that had samples here.
  std::uint32_t sets(Pixel pixel) const { return (*this)[pixel].sets; }
  /// NaN and infinite samples.
  std::uint32_t invalid(Pixel pixel) const { return (*this)[pixel].invalid; }
  /// Over all samples, the open set included; 0 without samples.
  Rgb mean(Pixel pixel) const { return (*this)[pixel].mean(); }
  /// Variance of the closed sets' mean, per channel, estimated from the scatter between the sets; infinite with fewer
  /// than two. Unbiased where samples are independent, or where all sets have as many samples.
  Rgb variance_of_mean(Pixel pixel) const { return (*this)[pixel].variance_of_mean(); }

  const std::vector<Accumulator>& accumulators() const { return pixels_; }
  std::vector<Accumulator>& accumulators() { return pixels_; }

 private:
  const Accumulator& operator[](Pixel pixel) const;

  Resolution resolution_;
  std::vector<Accumulator> pixels_;
};

/// What a film records besides the primal image.
struct FilmLayers {
  bool gradients = false;
  bool parts = false;
  bool debug = false;
  bool features = false;
  bool operator==(const FilmLayers&) const = default;
};

/// One of the two half-buffers.
struct FilmHalf {
  MomentImage primal;
  MomentImage dx, dy;                 ///< dx(x,y) estimates I(x+1,y) - I(x,y), dy alike; empty without gradients
  std::vector<Image<Rgb>> part_sums;  ///< per Part, sum over the primal's valid samples, float; empty without parts
  DebugImage debug;                   ///< empty without debug
  FeatureImage features;              ///< empty without features

  FeatureSink feature_sink(Pixel pixel) { return {features.empty() ? nullptr : &features, pixel}; }
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
  /// Adds a film of the same resolution and layers, half to half; all sets of both must be closed.
  void merge(const Film& other);

  // Both halves together, weighted by their counts.
  Image<Rgb> primal() const;  ///< 0 where there are no samples
  Image<Rgb> part(Part part) const;
  DebugImage debug() const;
  /// NaN and infinite samples of primal, dx and dy.
  std::uint64_t invalid_samples() const;

 private:
  FilmLayers layers_;
  FilmHalf halves_[2];
};

}  // namespace gradslc
