#include "reconstruction/local_regression.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

// Distances that halve a weight, or so: of means of unit normals, of albedos, of depths over the pixel's own. What the
// features' own noise makes of them is added.
constexpr float k_normal_distance2 = 1.0f / 16, k_albedo_distance2 = 0.01f, k_depth_distance = 0.05f;
constexpr float k_farthest = 8;            // weights below exp(-8) are none
constexpr float k_ridge = 2e-3f;           // of the sum of weights: keeps regressors that do not vary at 0
constexpr float k_least_variance = 1e-6f;  // of the guide, over its square

/// 1, position, normal, albedo, depth, guide: relative to the pixel, of size 1 or so; then the three channels, relative
/// to it, too.
constexpr int k_regressors = 11, k_columns = 16;
using Row = std::array<float, k_columns>;

float squared(Rgb a) { return a.r * a.r + a.g * a.g + a.b * a.b; }

/// The weighted normal equations of one pixel: upper triangle, and the right-hand sides beside it.
struct NormalEquations {
  alignas(64) std::array<Row, k_regressors> rows = {};

  void add(const Row& row, float weight) {
    for (int i = 0; i < k_regressors; ++i) {
      const float scaled = weight * row[static_cast<std::size_t>(i)];
      Row& sums = rows[static_cast<std::size_t>(i)];
      for (std::size_t j = 0; j < k_columns; ++j) sums[j] += scaled * row[j];
    }
  }
  float at(int i, int j) const { return rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; }

  /// The constant of the fit, per channel: what it is at the pixel. By elimination from the last regressor to the
  /// first, so that the constant comes last and nothing has to be substituted back.
  Rgb constant() const {
    auto m = rows;
    const float ridge = k_ridge * m[0][0];
    for (std::size_t i = 1; i < k_regressors; ++i) m[i][i] += ridge;
    for (std::size_t pivot = k_regressors - 1; pivot > 0; --pivot) {
      const float inverse = 1 / m[pivot][pivot];
      for (std::size_t i = 0; i < pivot; ++i) {
        const float factor = m[i][pivot] * inverse;
        for (std::size_t j = 0; j < k_columns; ++j) m[i][j] -= factor * m[pivot][j];
      }
    }
    return Rgb(m[0][k_regressors], m[0][k_regressors + 1], m[0][k_regressors + 2]) / m[0][0];
  }
};

class Filter {
 public:
  Filter(const FilterInput& input, const RegressionOptions& options)
      : input_(input), options_(options), luminance_(input.guide.resolution()) {
    for (std::size_t i = 0; i < luminance_.size(); ++i) luminance_[i] = luminance(input.guide[i]);
  }

  Rgb at(Pixel centre) const {
    const Resolution resolution = input_.values.resolution();
    const int r = options_.radius;
    NormalEquations equations;
    Rgb sum;
    float weights = 0;
    for (int y = std::max(0, centre.y - r); y <= std::min(resolution.height - 1, centre.y + r); ++y)
      for (int x = std::max(0, centre.x - r); x <= std::min(resolution.width - 1, centre.x + r); ++x) {
        Row row;
        const float weight = compare(centre, {x, y}, row);
        if (weight == 0) continue;
        if (options_.first_order)
          equations.add(row, weight);
        else
          sum += weight * (input_.values(x, y) - input_.values[centre]), weights += weight;
      }
    return input_.values[centre] + (options_.first_order ? equations.constant() : sum / weights);
  }

 private:
  /// The weight of a pixel for another, and its row of the regression.
  float compare(Pixel centre, Pixel pixel, Row& row) const {
    const FeatureBuffers& f = input_.features;
    const Rgb normal = f.normal[pixel] - f.normal[centre], albedo = f.albedo[pixel] - f.albedo[centre];
    const float depth = f.depth[pixel] - f.depth[centre];
    const float guide = luminance_[pixel] - luminance_[centre];
    const float guide_variance = input_.guide_variance[pixel] + input_.guide_variance[centre] +
                                 k_least_variance * luminance_[centre] * luminance_[centre] + 1e-30f;
    const float depth_scale = k_depth_distance * f.depth[centre];
    const auto noise = [&](const RgbImage& variance) {
      const Rgb both = variance[centre] + variance[pixel];
      return both.r + both.g + both.b;
    };
    const float depth_distance2 =
        depth_scale * depth_scale + f.depth_variance[centre] + f.depth_variance[pixel] + 1e-30f;
    const float distance = squared(normal) / (k_normal_distance2 + noise(f.normal_variance)) +
                           squared(albedo) / (k_albedo_distance2 + noise(f.albedo_variance)) +
                           depth * depth / depth_distance2 +
                           guide * guide / (static_cast<float>(options_.range) * guide_variance);
    if (!(distance < k_farthest)) return 0;
    const float place = 1 / static_cast<float>(options_.radius + 1);
    const Rgb value = input_.values[pixel] - input_.values[centre];
    row = {1,
           static_cast<float>(pixel.x - centre.x) * place,
           static_cast<float>(pixel.y - centre.y) * place,
           4 * normal.r,
           4 * normal.g,
           4 * normal.b,
           10 * albedo.r,
           10 * albedo.g,
           10 * albedo.b,
           depth / std::sqrt(depth_distance2),
           guide / (4 * std::sqrt(guide_variance)),
           value.r,
           value.g,
           value.b,
           0,
           0};
    return std::exp(-distance);
  }

  const FilterInput& input_;
  const RegressionOptions& options_;
  Image<float> luminance_;
};

}  // namespace

RgbImage filter(const FilterInput& input, const RegressionOptions& options) {
  const Filter kernel(input, options);
  RgbImage filtered(input.values.resolution());
  parallel_for(filtered.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) filtered[i] = kernel.at(filtered.resolution().pixel(i));
  });
  return filtered;
}

Image<float> variance_of_halves(const RgbImage& a, const RgbImage& b) {
  constexpr int k_radius = 5;
  const int width = a.width(), height = a.height();
  Image<float> rows(a.resolution()), boxes(a.resolution());
  const auto for_each_row = [&](const auto& body) {
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
    });
  };
  const auto half_square = [&](int x, int y) {
    const float difference = luminance(a(x, y)) - luminance(b(x, y));
    return 0.5f * difference * difference;
  };
  for_each_row([&](int y) {
    for (int x = 0; x < width; ++x)
      for (int i = std::max(0, x - k_radius); i <= std::min(width - 1, x + k_radius); ++i)
        rows(x, y) += half_square(i, y);
  });
  for_each_row([&](int y) {
    const int first = std::max(0, y - k_radius), last = std::min(height - 1, y + k_radius);
    for (int x = 0; x < width; ++x) {
      const int columns = std::min(width - 1, x + k_radius) - std::max(0, x - k_radius) + 1;
      for (int j = first; j <= last; ++j) boxes(x, y) += rows(x, j);
      boxes(x, y) /= static_cast<float>(columns * (last - first + 1));
    }
  });
  return boxes;
}

std::array<RgbImage, 2> cross_filter(const RgbImage& a, const RgbImage& b, const FeatureBuffers& features,
                                     const RegressionOptions& options) {
  const Image<float> variance = variance_of_halves(a, b);
  return {filter({a, b, variance, features}, options), filter({b, a, variance, features}, options)};
}

}  // namespace gradslc
