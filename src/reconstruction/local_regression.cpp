#include "reconstruction/local_regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/parallel.h"
#include "reconstruction/box_sums.h"

namespace gradslc {
namespace {

// Distances that halve a weight, or so: of means of unit normals, of albedos, of depths over the pixel's own. What the
// features' own noise makes of them is added.
constexpr float k_normal_distance2 = 1.0f / 16, k_albedo_distance2 = 0.01f, k_depth_distance = 0.05f;
constexpr float k_ridge = 2e-3f;           // of the sum of weights: keeps regressors that do not vary at 0
constexpr float k_least_variance = 1e-6f;  // of the guide, over its square
constexpr std::size_t k_lanes = 8;

/// exp(-x), or so: (1 + x/16)^-16, which compilers can vectorise.
float falling(float x) {
  const float a = 1 + x / 16, a2 = a * a, a4 = a2 * a2, a8 = a4 * a4;
  return 1 / (a8 * a8);
}

/// What is known of pixels, plane by plane, and around the image a margin of pixels that are `unused`, so that windows
/// can be read whole.
class Planes {
 public:
  enum Name : std::size_t {
    k_normal_x,
    k_normal_y,
    k_normal_z,
    k_normal_variance,  // summed over its components
    k_albedo_r,
    k_albedo_g,
    k_albedo_b,
    k_albedo_variance,
    k_depth,
    k_depth_variance,
    k_guide,  // luminance
    k_guide_variance,
    k_value_r,
    k_value_g,
    k_value_b,
    k_used,  // 1 in the image, 0 in the margin
    k_planes
  };

  Planes(const FilterInput& input, std::size_t margin)
      : margin_(margin),
        stride_(static_cast<std::size_t>(input.values.width()) + 2 * margin + k_lanes),
        plane_(stride_ * (static_cast<std::size_t>(input.values.height()) + 2 * margin)),
        values_(k_planes * plane_) {
    const Resolution resolution = input.values.resolution();
    const auto sum = [](Rgb a) { return a.r + a.g + a.b; };
    parallel_for(static_cast<std::size_t>(resolution.height), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * static_cast<std::size_t>(resolution.width);
           i < end * static_cast<std::size_t>(resolution.width); ++i) {
        const FeatureBuffers& f = input.features;
        const Rgb normal = f.normal[i], albedo = f.albedo[i], value = input.values[i];
        const std::array<float, k_planes> all{normal.r,
                                              normal.g,
                                              normal.b,
                                              sum(f.normal_variance[i]),
                                              albedo.r,
                                              albedo.g,
                                              albedo.b,
                                              sum(f.albedo_variance[i]),
                                              f.depth[i],
                                              f.depth_variance[i],
                                              luminance(input.guide[i]),
                                              input.guide_variance[i],
                                              value.r,
                                              value.g,
                                              value.b,
                                              1};
        const std::size_t at = index(resolution.pixel(i));
        for (std::size_t plane = 0; plane < k_planes; ++plane) values_[plane * plane_ + at] = all[plane];
      }
    });
  }

  std::size_t stride() const { return stride_; }
  /// Of a pixel in its plane; rows are `stride` apart.
  std::size_t index(Pixel pixel) const {
    return (static_cast<std::size_t>(pixel.y) + margin_) * stride_ + static_cast<std::size_t>(pixel.x) + margin_;
  }
  const float* operator[](Name name) const { return &values_[name * plane_]; }

 private:
  std::size_t margin_, stride_, plane_;
  std::vector<float> values_;
};

/// 1, position, normal, albedo, depth, guide: relative to the pixel, of size 1 or so; then the three channels, relative
/// to it, too.
constexpr std::size_t k_regressors = 11, k_columns = k_regressors + 3;

/// The pixels around one: their weights, and their columns of the regression. A lane is a pixel; those of a row are
/// padded to a multiple of 8 with weights of 0.
class Window {
 public:
  Window(const Planes& planes, const RegressionOptions& options)
      : planes_(planes),
        radius_(static_cast<std::size_t>(options.radius)),
        side_(2 * radius_ + 1),
        row_((side_ + k_lanes - 1) / k_lanes * k_lanes),
        range_(static_cast<float>(options.range)),
        weights_(side_ * row_),
        weighted_(side_ * row_) {
    for (std::vector<float>& column : columns_) column.assign(side_ * row_, 1);
    const float place = 1 / static_cast<float>(radius_ + 1);
    for (std::size_t i = 0; i < side_ * row_; ++i) {
      const std::size_t x = i % row_, y = i / row_;
      columns_[1][i] = (static_cast<float>(x) - static_cast<float>(radius_)) * place;
      columns_[2][i] = (static_cast<float>(y) - static_cast<float>(radius_)) * place;
    }
  }

  /// Weighs the pixels around one and compares them with it.
  void move_to(Pixel pixel) {
    const std::size_t centre = planes_.index(pixel), first = centre - radius_ * planes_.stride() - radius_;
    for (std::size_t y = 0; y < side_; ++y) compare_row(centre, first + y * planes_.stride(), y * row_);
  }

  /// The fit's value at the pixel, less the pixel's own: the constant of a regression, per channel.
  Rgb regression() {
    for (std::size_t i = 0; i < k_regressors; ++i) {
      std::transform(weights_.begin(), weights_.end(), columns_[i].begin(), weighted_.begin(), std::multiplies<>());
      for (std::size_t j = i; j < k_columns; ++j) sums_[i][j] = sums_[j][i] = dot(weighted_, columns_[j]);
    }
    return constant();
  }

  /// The weighted mean, less the pixel's own value.
  Rgb mean() const {
    const float sum = dot(weights_, columns_[0]);
    return Rgb(dot(weights_, columns_[k_regressors]), dot(weights_, columns_[k_regressors + 1]),
               dot(weights_, columns_[k_regressors + 2])) /
           sum;
  }

 private:
  static float dot(const std::vector<float>& a, const std::vector<float>& b) {
    const float *of_a = a.data(), *of_b = b.data();
    const std::size_t lanes = a.size();
    float sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t k = 0; k < lanes; ++k) sum += of_a[k] * of_b[k];
    return sum;
  }

  void compare_row(std::size_t centre, std::size_t first, std::size_t lane) {
    using enum Planes::Name;
    // A plane's row, and what it holds at the centre.
    struct Row {
      const float* of;
      float centre;
      float difference(std::size_t x) const { return of[x] - centre; }
      float sum(std::size_t x) const { return of[x] + centre; }
    };
    const auto row = [&](Planes::Name name) { return Row{planes_[name] + first, planes_[name][centre]}; };
    const auto column = [&](std::size_t number) { return &columns_[number][lane]; };
    const Row nx = row(k_normal_x), ny = row(k_normal_y), nz = row(k_normal_z), nv = row(k_normal_variance);
    const Row ar = row(k_albedo_r), ag = row(k_albedo_g), ab = row(k_albedo_b), av = row(k_albedo_variance);
    const Row depth = row(k_depth), depth_variance = row(k_depth_variance);
    const Row guide = row(k_guide), guide_variance = row(k_guide_variance);
    const Row vr = row(k_value_r), vg = row(k_value_g), vb = row(k_value_b);
    const float* used = planes_[k_used] + first;
    float* __restrict c3 = column(3), * __restrict c4 = column(4), * __restrict c5 = column(5);
    float* __restrict c6 = column(6), * __restrict c7 = column(7), * __restrict c8 = column(8);
    float* __restrict c9 = column(9), * __restrict c10 = column(10), * __restrict c11 = column(11);
    float* __restrict c12 = column(12), * __restrict c13 = column(13), * __restrict weights = &weights_[lane];
    const float least_depth2 = k_depth_distance * depth.centre * k_depth_distance * depth.centre + 1e-30f;
    const float least_guide2 = k_least_variance * guide.centre * guide.centre + 1e-30f;
#pragma omp simd
    for (std::size_t x = 0; x < row_; ++x) {
      const float dnx = nx.difference(x), dny = ny.difference(x), dnz = nz.difference(x);
      const float dar = ar.difference(x), dag = ag.difference(x), dab = ab.difference(x);
      const float dd = depth.difference(x), dg = guide.difference(x);
      const float depth2 = least_depth2 + depth_variance.sum(x), guide2 = least_guide2 + guide_variance.sum(x);
      const float distance = (dnx * dnx + dny * dny + dnz * dnz) / (k_normal_distance2 + nv.sum(x)) +
                             (dar * dar + dag * dag + dab * dab) / (k_albedo_distance2 + av.sum(x)) + dd * dd / depth2 +
                             dg * dg / (range_ * guide2);
      weights[x] = used[x] * falling(distance);
      c3[x] = 4 * dnx, c4[x] = 4 * dny, c5[x] = 4 * dnz;
      c6[x] = 10 * dar, c7[x] = 10 * dag, c8[x] = 10 * dab;
      c9[x] = dd / std::sqrt(depth2), c10[x] = 0.25f * dg / std::sqrt(guide2);
      c11[x] = vr.difference(x), c12[x] = vg.difference(x), c13[x] = vb.difference(x);
    }
    for (std::size_t x = side_; x < row_; ++x) weights[x] = 0;
  }

  /// By elimination from the last regressor to the first, so that the constant comes last and nothing has to be
  /// substituted back.
  Rgb constant() {
    auto& m = sums_;
    const float ridge = k_ridge * m[0][0];
    for (std::size_t i = 1; i < k_regressors; ++i) m[i][i] += ridge;
    for (std::size_t pivot = k_regressors - 1; pivot > 0; --pivot) {
      const float inverse = 1 / m[pivot][pivot];
      for (std::size_t i = 0; i < pivot; ++i) {
        const float factor = m[i][pivot] * inverse;
        for (std::size_t j = 0; j < m[i].size(); ++j) m[i][j] -= factor * m[pivot][j];
      }
    }
    return Rgb(m[0][k_regressors], m[0][k_regressors + 1], m[0][k_regressors + 2]) / m[0][0];
  }

  const Planes& planes_;
  std::size_t radius_, side_, row_;
  float range_;
  std::array<std::vector<float>, k_columns> columns_;
  std::vector<float> weights_, weighted_;
  std::array<std::array<float, 16>, k_columns> sums_ = {};
};

}  // namespace

RgbImage filter(const FilterInput& input, const RegressionOptions& options) {
  const Planes planes(input, static_cast<std::size_t>(options.radius));
  RgbImage filtered(input.values.resolution());
  parallel_for(filtered.size(), 512, [&](std::size_t begin, std::size_t end) {
    Window window(planes, options);
    for (std::size_t i = begin; i < end; ++i) {
      window.move_to(filtered.resolution().pixel(i));
      filtered[i] = input.values[i] + (options.first_order ? window.regression() : window.mean());
    }
  });
  return filtered;
}

Image<float> variance_of_halves(const RgbImage& a, const RgbImage& b) {
  constexpr int k_radius = 5;
  Image<float> half_squares(a.resolution());
  for (std::size_t i = 0; i < half_squares.size(); ++i) {
    const float difference = luminance(a[i]) - luminance(b[i]);
    half_squares[i] = 0.5f * difference * difference;
  }
  Image<float> variance = box_sums(half_squares, k_radius);
  const auto covered = [](int at, int end) {
    return std::min(end - 1, at + k_radius) - std::max(0, at - k_radius) + 1;
  };
  for (int y = 0; y < variance.height(); ++y)
    for (int x = 0; x < variance.width(); ++x)
      variance(x, y) /= static_cast<float>(covered(x, variance.width()) * covered(y, variance.height()));
  return variance;
}

std::array<RgbImage, 2> cross_filter(const RgbImage& a, const RgbImage& b, const FeatureBuffers& features,
                                     const RegressionOptions& options) {
  const Image<float> variance = variance_of_halves(a, b);
  return {filter({a, b, variance, features}, options), filter({b, a, variance, features}, options)};
}

}  // namespace gradslc
