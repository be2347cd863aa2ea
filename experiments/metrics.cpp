#include "experiments/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr double k_relative_floor_squared = 0.01;  // e2 = 0.01 mean(r)^2
constexpr double k_relative_floor = 0.1;           // e = 0.1 mean(r)
constexpr double k_trimmed_fraction = 0.001;

constexpr MetricEntry k_metrics[] = {
    {"mse", "mean of (x - r)^2"},
    {"relmse", "mean of (x - r)^2 / (r^2 + e2), e2 = 0.01 mean(r)^2"},
    {"relmse_trimmed", "relmse without the worst 0.1 % of the pixels (rounded up)"},
    {"mape", "mean of |x - r| / (|r| + e), e = 0.1 mean(r)"},
    {"smape", "mean of 2 |x - r| / (|x| + |r| + e), e = 0.1 mean(r)"},
    {"mean_bias", "mean(x) / mean(r) - 1"},
};

double mean_value(const RgbImage& image) {
  double sum = 0;
  for (const Rgb& pixel : image) sum += double{pixel.r} + double{pixel.g} + double{pixel.b};
  return sum / (3 * static_cast<double>(image.size()));
}

void require_finite(const RgbImage& image, const char* which) {
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (is_finite(image[i])) continue;
    const std::size_t width = static_cast<std::size_t>(image.width());
    throw_input_error("", fmt::format("{} has a value that is not finite at pixel ({}, {}); errors need finite images",
                                      which, i % width, i / width));
  }
}

void require_comparable(const RgbImage& image, const ReferenceImages& reference) {
  const Resolution wanted = reference.resolution(), given = image.resolution();
  if (given != wanted || image.empty()) {
    throw_input_error("", fmt::format("image is {}x{}, its reference {}x{}; both must have the same size", given.width,
                                      given.height, wanted.width, wanted.height));
  }
  assert(!reference.has_halves() || reference.b.resolution() == wanted);
  require_finite(image, "image");
  require_finite(reference.a, "reference");
  if (reference.has_halves()) require_finite(reference.b, "reference");
}

/// Sums over the three channels of one pixel.
struct PixelErrors {
  double square = 0, relative_square = 0, absolute = 0, symmetric = 0;
  double rank = 0;  // of (x-r)^2/(r^2+e2): never negative
};

PixelErrors pixel_errors(Rgb x, Rgb a, Rgb b, double mean) {
  const double e2 = k_relative_floor_squared * mean * mean, e = k_relative_floor * mean;
  PixelErrors errors;
  for (int c = 0; c < 3; ++c) {
    const double xc = x[c], ac = a[c], bc = b[c], r = (ac + bc) / 2;
    const double square = (xc - ac) * (xc - bc), difference = std::abs(xc - r);
    errors.square += square;
    errors.relative_square += square / (r * r + e2);
    errors.rank += difference * difference / (r * r + e2);
    errors.absolute += difference / (std::abs(r) + e);
    errors.symmetric += 2 * difference / (std::abs(xc) + std::abs(r) + e);
  }
  return errors;
}

/// Mean of relative_square without the pixels of the largest ranks; the later of equal ranks is the worse one.
double trimmed_relative_square(const std::vector<PixelErrors>& errors) {
  const std::size_t n = errors.size();
  const auto dropped = static_cast<std::size_t>(std::ceil(k_trimmed_fraction * static_cast<double>(n)));
  const std::size_t kept = n - std::min(dropped, n - 1);  // an image of one pixel keeps it
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept - 1), order.end(),
                   [&](std::size_t i, std::size_t j) {
                     return errors[i].rank != errors[j].rank ? errors[i].rank < errors[j].rank : i < j;
                   });
  order.resize(kept);
  std::sort(order.begin(), order.end());  // one order of summation, whatever nth_element left
  double sum = 0;
  for (const std::size_t i : order) sum += errors[i].relative_square;
  return sum / (3 * static_cast<double>(kept));
}

double positive_mean(const ReferenceImages& reference) {
  const double mean =
      reference.has_halves() ? (mean_value(reference.a) + mean_value(reference.b)) / 2 : mean_value(reference.a);
  if (!(mean > 0)) {
    throw_input_error("", fmt::format("reference has the mean {}; relative errors need one above 0", mean));
  }
  return mean;
}

}  // namespace

std::span<const MetricEntry> metric_registry() { return k_metrics; }

RgbImage ReferenceImages::mean() const {
  if (!has_halves()) return a;
  RgbImage result(a.resolution());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = 0.5f * (a[i] + b[i]);
  return result;
}

std::vector<Metric> compare_images(const RgbImage& image, const ReferenceImages& reference) {
  require_comparable(image, reference);
  const RgbImage& a = reference.a;
  const RgbImage& b = reference.has_halves() ? reference.b : reference.a;
  const double mean = positive_mean(reference);

  std::vector<PixelErrors> errors(image.size());
  PixelErrors sum;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = pixel_errors(image[i], a[i], b[i], mean);
    sum.square += errors[i].square;
    sum.relative_square += errors[i].relative_square;
    sum.absolute += errors[i].absolute;
    sum.symmetric += errors[i].symmetric;
  }
  const double count = 3 * static_cast<double>(image.size());
  return {{"mse", sum.square / count},
          {"relmse", sum.relative_square / count},
          {"relmse_trimmed", trimmed_relative_square(errors)},
          {"mape", sum.absolute / count},
          {"smape", sum.symmetric / count},
          {"mean_bias", mean_value(image) / mean - 1}};
}

std::vector<Metric> compare_images(const RgbImage& image, const RgbImage& reference) {
  return compare_images(image, ReferenceImages{reference, {}});
}

std::optional<double> reference_noise(const ReferenceImages& reference) {
  if (!reference.has_halves()) return std::nullopt;
  const RgbImage centre = reference.mean();
  require_comparable(centre, reference);
  const double mean = positive_mean(reference), e2 = k_relative_floor_squared * mean * mean;
  double sum = 0;
  for (std::size_t i = 0; i < centre.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double half = (double{reference.a[i][c]} - double{reference.b[i][c]}) / 2, r = centre[i][c];
      sum += half * half / (r * r + e2);
    }
  }
  return sum / (3 * static_cast<double>(centre.size()));
}

double metric_value(std::span<const Metric> metrics, std::string_view name) {
  const auto found = std::find_if(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.name == name; });
  assert(found != metrics.end());
  return found->value;
}

}  // namespace gradslc
