#include "reconstruction/buffers.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace gradslc {
namespace {

template <class T>
void check_size(const char* name, const Image<T>& image, Resolution expected) {
  if (image.resolution() != expected)
    throw_input_error("", fmt::format("reconstruction: {} has {} x {} pixels instead of {} x {}", name, image.width(),
                                      image.height(), expected.width, expected.height));
}

bool is_valid_variance(Rgb variance) { return variance.r >= 0 && variance.g >= 0 && variance.b >= 0; }

/// Checks the pixels of one of the three terms that are within `used`.
void check_term(const char* name, const RgbImage& values, const Image<float>& counts, const RgbImage& variances,
                Resolution used) {
  for (int y = 0; y < used.height; ++y)
    for (int x = 0; x < used.width; ++x) {
      const Rgb value = values(x, y), variance = variances(x, y);
      const float count = counts(x, y);
      if (!is_finite(value))
        throw_input_error("", fmt::format("reconstruction: {} of pixel ({}, {}) is ({}, {}, {}); it must be finite",
                                          name, x, y, value.r, value.g, value.b));
      if (!std::isfinite(count) || count < 0)
        throw_input_error("", fmt::format("reconstruction: count of {} of pixel ({}, {}) is {}; it must be finite and "
                                          "not negative",
                                          name, x, y, count));
      if (!is_valid_variance(variance))
        throw_input_error("", fmt::format("reconstruction: variance of {} of pixel ({}, {}) is ({}, {}, {}); it must "
                                          "not be negative",
                                          name, x, y, variance.r, variance.g, variance.b));
    }
}

}  // namespace

void check_primal(const ReconstructionBuffers& buffers) {
  const Resolution resolution = buffers.primal.resolution();
  if (buffers.primal.empty()) throw_input_error("", "reconstruction: the image has no pixels");
  check_size("the primal's count", buffers.primal_count, resolution);
  check_size("the primal's variance", buffers.primal_variance, resolution);
  check_term("primal", buffers.primal, buffers.primal_count, buffers.primal_variance, resolution);
}

void check_primal_and_gradients(const ReconstructionBuffers& buffers) {
  check_primal(buffers);
  const Resolution resolution = buffers.primal.resolution();
  for (const RgbImage* image : {&buffers.dx, &buffers.dy, &buffers.dx_variance, &buffers.dy_variance})
    check_size("a gradient or its variance", *image, resolution);
  for (const Image<float>* count : {&buffers.dx_count, &buffers.dy_count})
    check_size("a gradient's count", *count, resolution);
  check_term("dx", buffers.dx, buffers.dx_count, buffers.dx_variance, {resolution.width - 1, resolution.height});
  check_term("dy", buffers.dy, buffers.dy_count, buffers.dy_variance, {resolution.width, resolution.height - 1});
}

void check_features(const FeatureBuffers& features, Resolution resolution) {
  if (features.albedo.empty())
    throw_input_error("", "reconstruction: the image has no features (albedo, normal, depth); this one needs them");
  for (const RgbImage* image :
       {&features.albedo, &features.normal, &features.albedo_variance, &features.normal_variance}) {
    check_size("a feature", *image, resolution);
    for (const Rgb& value : *image)
      if (!is_finite(value)) throw_input_error("", "reconstruction: albedo and normal must be finite");
  }
  for (const Image<float>* image : {&features.depth, &features.depth_variance}) {
    check_size("the depth", *image, resolution);
    for (const float value : *image)
      if (!std::isfinite(value)) throw_input_error("", "reconstruction: depth must be finite");
  }
}

void check_halves(const ReconstructionInput& input) {
  for (const ReconstructionBuffers& half : input.halves) check_primal_and_gradients(half);
  check_size("the second half", input.halves[1].primal, input.halves[0].primal.resolution());
}

}  // namespace gradslc
