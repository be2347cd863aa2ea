#include "experiments/reconstruct.h"

#include <limits>

#include "core/parallel.h"
#include "film/film_io.h"

namespace gradslc {
namespace {

constexpr std::size_t k_pixels_per_chunk = 4096;

/// The three images that describe one recorded quantity.
struct Layer {
  RgbImage& mean;
  Image<float>& count;
  RgbImage& variance;

  void allocate(Resolution resolution) {
    mean = RgbImage(resolution);
    count = Image<float>(resolution, 0);
    variance = RgbImage(resolution, Rgb(std::numeric_limits<float>::infinity()));
  }
  void set(std::size_t i, const MomentImage::Accumulator& moments) {
    mean[i] = moments.mean();
    count[i] = static_cast<float>(moments.count);
    variance[i] = moments.variance_of_mean();
  }
};

Layer primal_layer(ReconstructionBuffers& b) { return {b.primal, b.primal_count, b.primal_variance}; }
Layer dx_layer(ReconstructionBuffers& b) { return {b.dx, b.dx_count, b.dx_variance}; }
Layer dy_layer(ReconstructionBuffers& b) { return {b.dy, b.dy_count, b.dy_variance}; }

void fill_layer(ReconstructionInput& input, Layer (*layer)(ReconstructionBuffers&), const MomentImage& first,
                const MomentImage& second) {
  Layer halves[2] = {layer(input.halves[0]), layer(input.halves[1])};
  Layer combined = layer(input.combined);
  parallel_for(first.accumulators().size(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      MomentImage::Accumulator moments[2] = {first.accumulators()[i], second.accumulators()[i]};
      for (int h = 0; h < 2; ++h) {
        moments[h].close_set();
        halves[h].set(i, moments[h]);
      }
      moments[0].merge(moments[1]);
      combined.set(i, moments[0]);
    }
  });
}

}  // namespace

ReconstructionInput reconstruction_input(const Film& film) {
  ReconstructionInput input;
  for (ReconstructionBuffers* buffers : {&input.halves[0], &input.halves[1], &input.combined}) {
    for (const auto layer : {primal_layer, dx_layer, dy_layer}) layer(*buffers).allocate(film.resolution());
  }
  const FilmHalf &first = film.half(0), &second = film.half(1);
  fill_layer(input, primal_layer, first.primal, second.primal);
  fill_layer(input, dx_layer, first.dx, second.dx);
  fill_layer(input, dy_layer, first.dy, second.dy);
  if (film.layers().features) {
    FeatureLayers layers = feature_layers(film);
    input.features = {std::move(layers.albedo),          std::move(layers.normal),
                      std::move(layers.depth),           std::move(layers.albedo_variance),
                      std::move(layers.normal_variance), std::move(layers.depth_variance)};
  }
  return input;
}

FinalImage final_image(const Film& film, const Reconstruction* reconstruction) {
  if (reconstruction == nullptr) return {film.primal(), std::nullopt};
  ReconstructionResult result = reconstruction->reconstruct(reconstruction_input(film));
  return {std::move(result.image), result.statistics};
}

}  // namespace gradslc
