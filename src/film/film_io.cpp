#include "film/film_io.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr std::size_t k_pixels_per_chunk = 16384;

template <class AccumulatorOf>
MomentLayers layers_of(Resolution resolution, const AccumulatorOf& accumulator_of) {
  MomentLayers layers{RgbImage(resolution), RgbImage(resolution), Image<float>(resolution)};
  parallel_for(resolution.pixels(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const MomentImage::Accumulator accumulator = accumulator_of(i);
      layers.mean[i] = accumulator.mean();
      layers.variance[i] = accumulator.variance_of_mean();
      layers.count[i] = static_cast<float>(accumulator.count);
    }
  });
  return layers;
}

struct NamedMoment {
  const char* name;
  MomentImage FilmHalf::*image;
};
constexpr NamedMoment k_moments[] = {{"primal", &FilmHalf::primal}, {"dx", &FilmHalf::dx}, {"dy", &FilmHalf::dy}};

void add_half(const std::string& moment, const std::string& half, const MomentImage& image,
              std::map<std::string, ExrLayer>& layers) {
  MomentLayers found = moment_layers(image);
  layers[moment + "_" + half] = std::move(found.mean);
  layers[moment + "_variance_" + half] = std::move(found.variance);
  layers[moment + "_count_" + half] = std::move(found.count);
}

Image<float> invalid_layer(const Film& film) {
  Image<float> invalid(film.resolution());
  for (int h = 0; h < 2; ++h)
    for (const NamedMoment& moment : k_moments) {
      const auto& accumulators = (film.half(h).*moment.image).accumulators();
      for (std::size_t i = 0; i < accumulators.size(); ++i) invalid[i] += static_cast<float>(accumulators[i].invalid);
    }
  return invalid;
}

/// Of an image's part, the place in k_part_names; -1: not known.
float part_index(const Largest& largest) { return largest.part ? static_cast<float>(*largest.part) : -1; }

struct DebugLayer {
  const char* name;
  float (*value)(const DebugImage::Accumulator& pixel);
};
using DebugPixel = DebugImage::Accumulator;
constexpr DebugLayer k_debug_layers[] = {
    {"debug_cut_size", [](const DebugPixel& p) { return static_cast<float>(p.cut_size / p.samples); }},
    {"debug_node_evaluations", [](const DebugPixel& p) { return static_cast<float>(p.node_evaluations / p.samples); }},
    {"debug_rays", [](const DebugPixel& p) { return static_cast<float>(p.rays / p.samples); }},
    {"debug_failed_shifts", [](const DebugPixel& p) { return static_cast<float>(p.failed_shifts / p.samples); }},
    {"debug_contribution", [](const DebugPixel& p) { return p.contribution.luminance; }},
    {"debug_contribution_part", [](const DebugPixel& p) { return part_index(p.contribution); }},
    {"debug_contribution_pass", [](const DebugPixel& p) { return static_cast<float>(p.contribution.pass); }},
    {"debug_sample", [](const DebugPixel& p) { return p.sample.luminance; }},
    {"debug_sample_pass", [](const DebugPixel& p) { return static_cast<float>(p.sample.pass); }},
};

/// Pixels without samples are 0.
Image<float> debug_layer(const DebugImage& debug, const DebugLayer& layer) {
  Image<float> image(debug.resolution());
  for (std::size_t i = 0; i < image.size(); ++i)
    if (debug[i].samples > 0) image[i] = layer.value(debug[i]);
  return image;
}

/// Variance of one sample of a gradient over that of one of the primal, both summed over the channels: where it is well
/// below 1, gradients tell more than the pixels themselves. 0 where either is unknown, or the primal's is 0.
Image<float> gradient_variance_ratio(const MomentLayers& gradient, const MomentLayers& primal) {
  const auto of_one = [](const MomentLayers& moment, std::size_t i) {
    const Rgb variance = moment.variance[i];
    return (variance.r + variance.g + variance.b) * moment.count[i];
  };
  Image<float> ratio(gradient.count.resolution());
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    const float value = of_one(gradient, i) / of_one(primal, i);
    if (std::isfinite(value)) ratio[i] = value;
  }
  return ratio;
}

}  // namespace

MomentLayers moment_layers(const MomentImage& image) {
  return layers_of(image.resolution(), [&](std::size_t i) { return image.accumulators()[i]; });
}

MomentLayers moment_layers(const MomentImage& a, const MomentImage& b) {
  assert(a.resolution() == b.resolution());
  return layers_of(a.resolution(), [&](std::size_t i) {
    MomentImage::Accumulator both = a.accumulators()[i];
    both.merge(b.accumulators()[i]);
    return both;
  });
}

FeatureLayers feature_layers(const Film& film) {
  const Resolution resolution = film.resolution();
  FeatureLayers layers{RgbImage(resolution), RgbImage(resolution), Image<float>(resolution),
                       RgbImage(resolution), RgbImage(resolution), Image<float>(resolution)};
  const auto as_rgb = [](const Vec3& v) { return Rgb(v.x, v.y, v.z); };
  FeatureImage both = film.half(0).features;
  both.merge(film.half(1).features);
  for (std::size_t i = 0; i < resolution.pixels(); ++i) {
    const auto count =
        static_cast<float>(film.half(0).primal.accumulators()[i].count + film.half(1).primal.accumulators()[i].count);
    const auto [mean, variance] = both.moments(i, count);
    layers.albedo[i] = mean.albedo, layers.normal[i] = as_rgb(mean.normal), layers.depth[i] = mean.depth;
    layers.albedo_variance[i] = variance.albedo, layers.normal_variance[i] = as_rgb(variance.normal);
    layers.depth_variance[i] = variance.depth;
  }
  return layers;
}

std::map<std::string, ExrLayer> film_layers(const Film& film) {
  std::map<std::string, ExrLayer> layers;
  const MomentLayers primal = moment_layers(film.half(0).primal, film.half(1).primal);
  for (const NamedMoment& moment : k_moments) {
    const MomentImage &a = film.half(0).*moment.image, &b = film.half(1).*moment.image;
    const bool is_primal = moment.image == &FilmHalf::primal;
    if (!is_primal && !film.layers().gradients) continue;
    const std::string name = moment.name;
    MomentLayers both = is_primal ? primal : moment_layers(a, b);
    if (!is_primal && film.layers().debug) layers["debug_" + name + "_ratio"] = gradient_variance_ratio(both, primal);
    layers[name] = std::move(both.mean);
    layers[is_primal ? "variance" : name + "_variance"] = std::move(both.variance);
    add_half(name, "a", a, layers);
    add_half(name, "b", b, layers);
  }
  layers["invalid"] = invalid_layer(film);
  if (film.layers().parts)
    for (int p = 0; p < k_part_count; ++p) layers[k_part_names[p]] = film.part(static_cast<Part>(p));
  if (film.layers().features) {
    FeatureLayers features = feature_layers(film);
    layers["albedo"] = std::move(features.albedo), layers["albedo_variance"] = std::move(features.albedo_variance);
    layers["normal"] = std::move(features.normal), layers["normal_variance"] = std::move(features.normal_variance);
    layers["depth"] = std::move(features.depth), layers["depth_variance"] = std::move(features.depth_variance);
  }
  if (film.layers().debug) {
    const DebugImage debug = film.debug();
    for (const DebugLayer& layer : k_debug_layers) layers[layer.name] = debug_layer(debug, layer);
  }
  return layers;
}

}  // namespace gradslc
