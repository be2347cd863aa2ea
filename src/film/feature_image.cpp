#include "film/feature_image.h"

#include <algorithm>
#include <cassert>

namespace gradslc {
namespace {

using Values = std::array<float, FeatureImage::k_values>;

Values values_of(const SurfaceFeatures& f) {
  return {f.albedo.r, f.albedo.g, f.albedo.b, f.normal.x, f.normal.y, f.normal.z, f.depth};
}
SurfaceFeatures features_of(const Values& v) { return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]}; }

}  // namespace

void FeatureImage::add(Pixel pixel, const SurfaceFeatures& features) {
  Sums& sums = pixels_[pixel];
  const Values values = values_of(features);
  for (std::size_t i = 0; i < k_values; ++i) sums.sum[i] += values[i], sums.square_sum[i] += values[i] * values[i];
}

void FeatureImage::merge(const FeatureImage& other) {
  assert(resolution() == other.resolution());
  for (std::size_t p = 0; p < pixels_.size(); ++p)
    for (std::size_t i = 0; i < k_values; ++i) {
      pixels_[p].sum[i] += other.pixels_[p].sum[i];
      pixels_[p].square_sum[i] += other.pixels_[p].square_sum[i];
    }
}

FeatureImage::MeanAndVariance FeatureImage::moments(std::size_t index, float count) const {
  if (count <= 0) return {};
  const Sums& sums = pixels_[index];
  Values mean, variance = {};
  for (std::size_t i = 0; i < k_values; ++i) {
    mean[i] = sums.sum[i] / count;
    if (count > 1) variance[i] = std::max(0.0f, sums.square_sum[i] / count - mean[i] * mean[i]) / (count - 1);
  }
  return {features_of(mean), features_of(variance)};
}

}  // namespace gradslc
