#include "film/film.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr std::size_t k_pixels_per_chunk = 16384;

Rgb to_rgb(const std::array<double, 3>& value) {
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

std::uint64_t invalid_samples_of(const MomentImage& image) {
  const std::vector<MomentImage::Accumulator>& pixels = image.accumulators();
  return parallel_sum<std::uint64_t>(pixels.size(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint64_t sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += pixels[i].invalid;
    return sum;
  });
}

}  // namespace

void MomentImage::Accumulator::add(Rgb value) {
  if (!is_finite(value)) {
    ++invalid;
    return;
  }
  for (int c = 0; c < 3; ++c) {
    sum[c] += static_cast<double>(value[c]);
    open_sum[c] += static_cast<double>(value[c]);
  }
  ++count;
  ++open_count;
}

void MomentImage::Accumulator::close_set() {
  if (open_count == 0) return;
  for (int c = 0; c < 3; ++c) square_sum[c] += open_sum[c] * open_sum[c] / open_count;
  ++sets;
  open_sum = {};
  open_count = 0;
}

void MomentImage::Accumulator::merge(const Accumulator& other) {
  for (int c = 0; c < 3; ++c) {
    sum[c] += other.sum[c];
    open_sum[c] += other.open_sum[c];
    square_sum[c] += other.square_sum[c];
  }
  count += other.count;
  open_count += other.open_count;
  sets += other.sets;
  invalid += other.invalid;
}

Rgb MomentImage::Accumulator::mean() const {
  if (count == 0) return Rgb(0);
  return to_rgb({sum[0] / count, sum[1] / count, sum[2] / count});
}

Rgb MomentImage::Accumulator::variance_of_mean() const {
  if (sets < 2) return Rgb(std::numeric_limits<float>::infinity());
  const double n = count - open_count;
  std::array<double, 3> variance;
  for (int c = 0; c < 3; ++c) {
    const double closed_sum = sum[c] - open_sum[c];
    const double mean_square = (square_sum[c] - closed_sum * closed_sum / n) / (sets - 1);
    variance[c] = std::max(0.0, mean_square) / n;
  }
  return to_rgb(variance);
}

MomentImage::MomentImage(Resolution resolution) : resolution_(resolution), pixels_(resolution.pixels()) {}

const MomentImage::Accumulator& MomentImage::operator[](Pixel pixel) const {
  assert(resolution_.contains(pixel));
  return pixels_[resolution_.index(pixel)];
}

void MomentImage::add(Pixel pixel, Rgb value) {
  assert(resolution_.contains(pixel));
  pixels_[resolution_.index(pixel)].add(value);
}

void MomentImage::close_set() {
  parallel_for(pixels_.size(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pixels_[i].close_set();
  });
}

void MomentImage::merge(const MomentImage& other) {
  assert(resolution_ == other.resolution_);
  parallel_for(pixels_.size(), k_pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      assert(pixels_[i].open_count == 0 && other.pixels_[i].open_count == 0);
      pixels_[i].merge(other.pixels_[i]);
    }
  });
}

Film::Film(Resolution resolution, FilmLayers layers) : layers_(layers) {
  for (FilmHalf& half : halves_) {
    half.primal = MomentImage(resolution);
    if (layers.gradients) half.dx = half.dy = MomentImage(resolution);
    if (layers.parts) half.part_sums.assign(k_part_count, Image<Rgb>(resolution));
    if (layers.debug) half.debug = DebugImage(resolution);
    if (layers.features) half.features = FeatureImage(resolution);
  }
}

void Film::close_set(int half_index) {
  FilmHalf& half = halves_[half_index];
  half.primal.close_set();
  half.dx.close_set();
  half.dy.close_set();
}

void Film::merge(const Film& other) {
  assert(layers_ == other.layers_);
  for (int h = 0; h < 2; ++h) {
    const FilmHalf& from = other.halves_[h];
    halves_[h].primal.merge(from.primal);
    halves_[h].dx.merge(from.dx);
    halves_[h].dy.merge(from.dy);
    for (std::size_t p = 0; p < from.part_sums.size(); ++p)
      for (std::size_t i = 0; i < from.part_sums[p].size(); ++i) halves_[h].part_sums[p][i] += from.part_sums[p][i];
    halves_[h].debug.merge(from.debug);
    halves_[h].features.merge(from.features);
  }
}

Image<Rgb> Film::primal() const {
  const std::vector<MomentImage::Accumulator>& first = halves_[0].primal.accumulators();
  const std::vector<MomentImage::Accumulator>& second = halves_[1].primal.accumulators();
  Image<Rgb> image(resolution());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t count = first[i].count + second[i].count;
    if (count == 0) continue;
    std::array<double, 3> mean;
    for (int c = 0; c < 3; ++c) mean[c] = (first[i].sum[c] + second[i].sum[c]) / count;
    image[i] = to_rgb(mean);
  }
  return image;
}

Image<Rgb> Film::part(Part part) const {
  assert(layers_.parts);
  const auto p = static_cast<std::size_t>(part);
  Image<Rgb> image(resolution());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t count = halves_[0].primal.accumulators()[i].count + halves_[1].primal.accumulators()[i].count;
    if (count > 0) image[i] = (halves_[0].part_sums[p][i] + halves_[1].part_sums[p][i]) / static_cast<float>(count);
  }
  return image;
}

DebugImage Film::debug() const {
  DebugImage both = halves_[0].debug;
  both.merge(halves_[1].debug);
  return both;
}

std::uint64_t Film::invalid_samples() const {
  std::uint64_t total = 0;
  for (const FilmHalf& half : halves_)
    for (const MomentImage* image : {&half.primal, &half.dx, &half.dy}) total += invalid_samples_of(*image);
  return total;
}

}  // namespace gradslc
