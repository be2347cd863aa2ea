#pragma once

#include <array>

#include "core/image.h"
#include "core/vec.h"

namespace gradslc {

/// What guides filters: the surface that a camera sample shows, all 0 where it shows none.
struct SurfaceFeatures {
  Rgb albedo;
  Vec3 normal;      ///< shading normal, unit, on the camera's side
  float depth = 0;  ///< distance to the camera, > 0
};

/// Means and variances of the features of each pixel's samples. A sample that shows no surface need not be added.
class FeatureImage {
 public:
  FeatureImage() = default;
  explicit FeatureImage(Resolution resolution) : pixels_(resolution) {}

  bool empty() const { return pixels_.empty(); }
  Resolution resolution() const { return pixels_.resolution(); }
  /// Different pixels may be added to concurrently.
  void add(Pixel pixel, const SurfaceFeatures& features);
  void merge(const FeatureImage& other);

  static constexpr std::size_t k_values = 7;  ///< albedo, normal, depth
  struct MeanAndVariance {
    SurfaceFeatures mean;
    SurfaceFeatures variance;  ///< of the mean, per value; 0 below two samples
  };
  /// Over `count` samples of the pixel, those that were not added included.
  MeanAndVariance moments(std::size_t index, float count) const;

 private:
  struct Sums {
    std::array<float, k_values> sum = {}, square_sum = {};
  };
  Image<Sums> pixels_;
};

/// Where the features of one sample go; to nowhere without an image.
struct FeatureSink {
  FeatureImage* image = nullptr;
  Pixel pixel;
};

}  // namespace gradslc
