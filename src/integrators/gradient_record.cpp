#include "integrators/gradient_record.h"

#include "core/parallel.h"

namespace gradslc {

void StencilValues::begin(Resolution resolution, Stencil stencil, bool logged) {
  resolution_ = resolution, offsets_ = stencil_offsets(stencil);
  values_.assign(resolution.pixels() * offsets_.size(), PartValues());
  logs_.resize(logged ? values_.size() : 0);
  prefix_logs_.resize(logged ? resolution.pixels() : 0);
}

PathLog* StencilValues::begin_log(const LoggedSamples& logged, Pixel base, std::size_t k) {
  return logged.any() ? logged.begin_part(base + offsets_[k], logs_[index(base, k)]) : nullptr;
}

PathLog* StencilValues::begin_prefix_log(const LoggedSamples& logged, Pixel pixel) {
  return logged.any() ? logged.begin_part(pixel, prefix_logs_[resolution_.index(pixel)]) : nullptr;
}

void StencilValues::record(const LoggedSamples& logged, FilmHalf& half, bool gradients) const {
  parallel_for(resolution_.pixels(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pixel pixel = resolution_.pixel(i);
      record_primal(pixel, logged, half);
      if (!gradients) continue;
      record_difference(pixel, {1, 0}, k_right, k_left, half.dx);
      record_difference(pixel, {0, 1}, k_lower, k_upper, half.dy);
    }
  });
}

void StencilValues::record_primal(Pixel pixel, const LoggedSamples& logged, FilmHalf& half) const {
  const auto for_each_base = [&](const auto& body) {
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const Pixel base{pixel.x - offsets_[k].x, pixel.y - offsets_[k].y};
      if (resolution_.contains(base)) body(base, k);
    }
  };
  PartValues sum;
  int groups = 0;
  for_each_base([&](Pixel base, std::size_t k) { sum += values_[index(base, k)], ++groups; });
  const float share = 1 / static_cast<float>(groups);
  sum *= share;
  PathLog memory;
  PathLog* const log = logged.begin(pixel, memory);
  if (log) {
    log->append(prefix_logs_[resolution_.index(pixel)], 1);
    for_each_base([&](Pixel base, std::size_t k) {
      log->note(happening::Group{base, groups});
      log->append(logs_[index(base, k)], share);
    });
  }
  gradslc::record(half, pixel, sum, log);
}

void StencilValues::record_difference(Pixel pixel, Pixel step, std::size_t forward, std::size_t backward,
                                      MomentImage& moments) const {
  const Pixel other = pixel + step;
  if (!resolution_.contains(other)) return;
  Rgb difference = total(pixel, forward) - total(pixel, k_base);
  if (offsets_.size() > backward) difference = 0.5f * (difference + total(other, k_base) - total(other, backward));
  moments.add(pixel, difference);
}

}  // namespace gradslc
