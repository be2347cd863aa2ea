#include "scene/lights/environment_map.h"

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "scene/lights/bounding_disk.h"

namespace gradslc {
namespace {

constexpr std::size_t k_bands_per_chunk = 8;

/// Integrals from 0 to t of sin(theta) and t sin(theta) over dtheta = height dt, theta = first + t height.
struct BandIntegrals {
  double plain, linear;
};
BandIntegrals band_integrals(double first, double height, double t) {
  const double theta = first + t * height;
  return {std::cos(first) - std::cos(theta), (std::sin(theta) - std::sin(first)) / height - t * std::cos(theta)};
}

/// t in [0,1] with density proportional to (upper (1-t) + lower t) sin(theta): the inverse of its integral, by Newton's
/// method kept inside a shrinking interval.
double sample_down_band(double first, double height, double upper, double lower, double u) {
  const auto integral = [&](double t) {
    const BandIntegrals to_t = band_integrals(first, height, t);
    return upper * (to_t.plain - to_t.linear) + lower * to_t.linear;
  };
  constexpr int k_max_steps = 40;
  constexpr double k_precision = 1e-8;
  const double target = u * integral(1);
  double low = 0, high = 1, t = 0.5;
  for (int step = 0; step < k_max_steps; ++step) {
    const double excess = integral(t) - target;
    (excess < 0 ? low : high) = t;
    const double slope = (upper + (lower - upper) * t) * std::sin(first + t * height) * height;
    double next = slope > 0 ? t - excess / slope : -1;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (std::abs(next - t) < k_precision) return next;
    t = next;
  }
  return t;
}

/// s in [0,1] with density proportional to left (1-s) + right s.
double sample_across_cell(double left, double right, double u) {
  const double denominator = left + std::sqrt(left * left + u * (right * right - left * left));
  return denominator > 0 ? std::min(u * (left + right) / denominator, 1.0) : u;
}

Rgb mix(Rgb a, Rgb b, float t) { return (1 - t) * a + t * b; }

}  // namespace

EnvironmentMap::EnvironmentMap(RgbImage radiance, const Orientation& orientation, std::string_view kind)
    : map_(std::move(radiance)),
      orientation_(orientation),
      kind_(kind),
      cells_(static_cast<std::size_t>(map_.height()) + 1) {
  assert(!map_.empty());
  std::vector<double> luminances(cells_.size());
  std::vector<std::array<double, 3>> radiances(cells_.size());
  const double cell_width = 2 * std::numbers::pi / map_.width();
  parallel_for(cells_.size(), k_bands_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Band strip = band(static_cast<int>(i));
      cells_[i] = DiscreteDistribution(cell_weights(strip));
      luminances[i] = cells_[i].total() * cell_width;
      for (int x = 0; x < map_.width(); ++x)  // each texel is the left and the right end of a cell
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const int c = static_cast<int>(channel);
          radiances[i][channel] += cell_width * (strip.upper_weight * map_(x, strip.upper)[c] +
                                                 strip.lower_weight * map_(x, strip.lower)[c]);
        }
    }
  });
  bands_ = DiscreteDistribution(luminances);
  luminance_integral_ = bands_.total();
  std::array<double, 3> sum{};
  for (const auto& of_band : radiances)
    for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += of_band[channel];
  integral_ = {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

EnvironmentMap::Band EnvironmentMap::band(int index) const {
  const int rows = map_.height();
  const double row_height = std::numbers::pi / rows;
  const double first = index == 0 ? 0 : (index - 0.5) * row_height;
  const double last = index == rows ? std::numbers::pi : (index + 0.5) * row_height;
  const BandIntegrals whole = band_integrals(first, last - first, 1);
  return {std::max(index - 1, 0), std::min(index, rows - 1),  first,
          last - first,           whole.plain - whole.linear, whole.linear};
}

double EnvironmentMap::texel_luminance(int column, int row) const { return luminance(map_(column, row)); }

/// Integrals of the bilinear luminance over the band's cells, in units of a cell's width.
std::vector<double> EnvironmentMap::cell_weights(const Band& band) const {
  const int columns = map_.width();
  std::vector<double> weights(static_cast<std::size_t>(columns));
  double upper = texel_luminance(0, band.upper), lower = texel_luminance(0, band.lower);
  for (int x = 0; x < columns; ++x) {
    const int right = x + 1 < columns ? x + 1 : 0;
    const double upper_right = texel_luminance(right, band.upper), lower_right = texel_luminance(right, band.lower);
    weights[static_cast<std::size_t>(x)] =
        (band.upper_weight * (upper + upper_right) + band.lower_weight * (lower + lower_right)) / 2;
    upper = upper_right, lower = lower_right;
  }
  return weights;
}

Vec3 EnvironmentMap::sample_direction(Vec2 u) const {
  const DiscreteDistribution::Sample row = bands_.sample(u.y);
  const DiscreteDistribution::Sample column = cells_[row.index].sample(u.x);
  const Band strip = band(static_cast<int>(row.index));
  const int left = static_cast<int>(column.index), right = left + 1 < map_.width() ? left + 1 : 0;
  const double upper_left = texel_luminance(left, strip.upper), upper_right = texel_luminance(right, strip.upper);
  const double lower_left = texel_luminance(left, strip.lower), lower_right = texel_luminance(right, strip.lower);

  const double t =
      sample_down_band(strip.theta, strip.height, upper_left + upper_right, lower_left + lower_right, row.remapped);
  const double s = sample_across_cell(upper_left + t * (lower_left - upper_left),
                                      upper_right + t * (lower_right - upper_right), column.remapped);
  const double theta = strip.theta + t * strip.height;
  const double phi = 2 * std::numbers::pi * (left + 0.5 + s) / map_.width();
  const double sine = std::sin(theta);
  return orientation_.to_world({static_cast<float>(sine * std::sin(phi)), static_cast<float>(std::cos(theta)),
                                static_cast<float>(-sine * std::cos(phi))});
}

Rgb EnvironmentMap::radiance(Vec3 direction) const {
  const Vec3 local = orientation_.to_local(direction);
  const float u = std::atan2(local.x, -local.z) / (2 * k_pi);  // [-1/2, 1/2]
  const float v = std::atan2(std::sqrt(local.x * local.x + local.z * local.z), local.y) / k_pi;
  const float x = u * static_cast<float>(map_.width()) - 0.5f;
  const float y = std::clamp(v * static_cast<float>(map_.height()) - 0.5f, 0.0f, static_cast<float>(map_.height() - 1));
  const auto wrapped = [&](int column) { return (column + 2 * map_.width()) % map_.width(); };
  const int left = wrapped(static_cast<int>(std::floor(x))), right = wrapped(left + 1);
  const int upper = static_cast<int>(y), lower = std::min(upper + 1, map_.height() - 1);
  const float s = x - std::floor(x), t = y - static_cast<float>(upper);
  return mix(mix(map_(left, upper), map_(right, upper), s), mix(map_(left, lower), map_(right, lower), s), t);
}

float EnvironmentMap::pdf_of(Rgb radiance) const {
  return luminance_integral_ > 0 ? static_cast<float>(luminance(radiance) / luminance_integral_) : 0;
}

float EnvironmentMap::pdf_direct(Vec3 direction) const { return pdf_of(radiance(direction)); }

Rgb EnvironmentMap::power(const BoundingSphere& scene) const { return disk_area(scene) * integral_; }

std::optional<DirectSample> EnvironmentMap::sample_direct(Point3 /*reference*/, Vec2 u) const {
  if (!(luminance_integral_ > 0)) return std::nullopt;
  const Vec3 wi = sample_direction(u);
  const Rgb arriving = radiance(wi);
  const float pdf = pdf_of(arriving);
  if (!(pdf > 0)) return std::nullopt;  // rounded into the black beside it
  return DirectSample{.wi = wi, .radiance = arriving, .pdf_solid_angle = pdf, .position = {}, .infinite = true};
}

EmissionSample EnvironmentMap::sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const {
  const Vec3 towards_light = sample_direction(u_direction);
  const Rgb arriving = radiance(towards_light);
  const float pdf = pdf_of(arriving);
  return emit_through_disk(towards_light, pdf > 0 ? arriving / pdf : Rgb(), u_point, extent);
}

std::size_t EnvironmentMap::memory_bytes() const {
  std::size_t bytes = map_.size() * sizeof(Rgb) + (bands_.size() + 1) * sizeof(double);
  for (const DiscreteDistribution& cells : cells_) bytes += (cells.size() + 1) * sizeof(double);
  return bytes;
}

}  // namespace gradslc
