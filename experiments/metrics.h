#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

namespace gradslc {

/// One measured error. Names as in k_metrics.
struct Metric {
  std::string name;
  double value;
};

struct MetricEntry {
  const char* name;
  const char* meaning;
};
/// The only list of metrics, in the order in which they are returned and written.
std::span<const MetricEntry> metric_registry();

/// What an image is compared with. With two independent halves the reference is their mean and the squares of mse,
/// relmse and relmse_trimmed are products (x - a)(x - b), which do not carry the reference's noise (DESIGN 8); with one
/// image
/// (`b` empty) they are plain squares.
struct ReferenceImages {
  RgbImage a, b;

  bool has_halves() const { return !b.empty(); }
  Resolution resolution() const { return a.resolution(); }
  RgbImage mean() const;
};

/// All metrics of metric_registry(). Error (input) where the sizes differ, a value is not finite, or the reference's
/// mean is not positive, since relative errors have no meaning then.
std::vector<Metric> compare_images(const RgbImage& image, const ReferenceImages& reference);
/// The same against a single image: plain squares, which carry its noise.
std::vector<Metric> compare_images(const RgbImage& image, const RgbImage& reference);

/// Expected relmse of the mean of the two halves against the truth: mean of ((a - b) / 2)^2 / (r^2 + e2).
/// nullopt with a single image, whose error is not known.
std::optional<double> reference_noise(const ReferenceImages& reference);

/// Value of the named metric; the name must be there.
double metric_value(std::span<const Metric> metrics, std::string_view name);

}  // namespace gradslc
