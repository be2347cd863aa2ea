#include "experiments/reconstruct.h"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <variant>

#include "core/error.h"
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

/// Layers of a run's file by their names.
struct LayerReader {
  const ExrImage& run;
  const std::filesystem::path& path;

  bool has(const std::string& name) const { return run.layers.contains(name); }
  template <class T>
  const Image<T>& layer(const std::string& name) const {
    const auto found = run.layers.find(name);
    const auto* image = found == run.layers.end() ? nullptr : std::get_if<Image<T>>(&found->second);
    if (!image) throw_input_error(path.string(), fmt::format("has no layer \"{}\": must be a run's EXR", name));
    return *image;
  }
  const RgbImage& colours(const std::string& name) const { return layer<Rgb>(name); }
  const Image<float>& values(const std::string& name) const { return layer<float>(name); }

  /// The layers of one term: of both halves, and of both together.
  void read_moment(ReconstructionInput& input, Layer (*term)(ReconstructionBuffers&), const std::string& name,
                   const std::string& variance) const {
    for (int h = 0; h < 2; ++h) {
      const char* const half = h == 0 ? "a" : "b";
      Layer to = term(input.halves[h]);
      to.mean = colours(fmt::format("{}_{}", name, half));
      to.variance = colours(fmt::format("{}_variance_{}", name, half));
      to.count = values(fmt::format("{}_count_{}", name, half));
    }
    Layer both = term(input.combined);
    both.mean = colours(name), both.variance = colours(variance);
    for (std::size_t i = 0; i < both.count.size(); ++i)
      both.count[i] = term(input.halves[0]).count[i] + term(input.halves[1]).count[i];
  }
};

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

ReconstructionInput reconstruction_input(const ExrImage& run, const std::filesystem::path& path) {
  const LayerReader reader{run, path};
  const Resolution resolution = run.image.resolution();
  ReconstructionInput input;
  for (ReconstructionBuffers* buffers : {&input.halves[0], &input.halves[1], &input.combined})
    for (const auto layer : {primal_layer, dx_layer, dy_layer}) layer(*buffers).allocate(resolution);
  reader.read_moment(input, primal_layer, "primal", "variance");
  if (reader.has("dx")) {
    reader.read_moment(input, dx_layer, "dx", "dx_variance");
    reader.read_moment(input, dy_layer, "dy", "dy_variance");
  }
  if (reader.has("albedo"))
    input.features = {
        reader.colours("albedo"),          reader.colours("normal"),          reader.values("depth"),
        reader.colours("albedo_variance"), reader.colours("normal_variance"), reader.values("depth_variance")};
  return input;
}

FinalImage final_image(const Film& film, const Reconstruction* reconstruction) {
  if (reconstruction == nullptr) return {film.primal(), std::nullopt};
  ReconstructionResult result = reconstruction->reconstruct(reconstruction_input(film));
  return {std::move(result.image), result.statistics};
}

}  // namespace gradslc
