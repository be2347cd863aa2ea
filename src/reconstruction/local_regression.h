#pragma once

#include <array>

#include "reconstruction/reconstruction.h"

namespace gradslc {

/// What a filter smooths, and by what it tells pixels apart. All images have one size; values are finite.
struct FilterInput {
  const RgbImage& values;
  const RgbImage& guide;               ///< the same image, with noise that is independent of `values`
  const Image<float>& guide_variance;  ///< of its luminance, smoothed; >= 0
  const FeatureBuffers& features;
};

struct RegressionOptions {
  int radius = 6;    ///< of the window of (2 radius + 1)^2 pixels
  double range = 8;  ///< k: luminances of the guide further apart than sqrt(k times their variances) are told apart
  bool first_order = true;  ///< false: the weighted mean, a joint bilateral filter
};

/// Cross-filtering by local first-order regression (Moon, Carr and Yoon 2014, "Adaptive rendering based on weighted
/// local regression"; Bitterli et al. 2016, "Nonlinearly weighted first-order regression for denoising Monte Carlo
/// renderings"). Around each pixel the values are fitted by a linear function of position, normal, albedo, depth and
/// guide, weighted by how near the pixels are in all but position; the pixel becomes the fit's value at itself.
/// Values that are such a function are left as they are.
RgbImage filter(const FilterInput& input, const RegressionOptions& options);

/// Variance of the luminance of one of two images with independent noise, smoothed over 11 x 11 pixels: the mean of
/// half their squared differences.
Image<float> variance_of_halves(const RgbImage& a, const RgbImage& b);

/// Both halves, each filtered with the other as its guide.
std::array<RgbImage, 2> cross_filter(const RgbImage& a, const RgbImage& b, const FeatureBuffers& features,
                                     const RegressionOptions& options);

}  // namespace gradslc
