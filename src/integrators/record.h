#pragma once

#include "film/film.h"
#include "integrators/path.h"

namespace gradslc {

/// Adds one sample of a pixel to a half of the film: the whole, and the parts and debug images where the film keeps
/// them. Ends the sample's log, if it has one.
inline void record(FilmHalf& half, Pixel pixel, const PartValues& sample, PathLog* log) {
  half.primal.add(pixel, sample.total());
  for (std::size_t part = 0; part < half.part_sums.size(); ++part) half.part_sums[part][pixel] += sample.values[part];
  if (!log) return;
  log->finish(sample.total());
  if (!half.debug.empty()) half.debug.add(pixel, log->sample());
}

/// The same for a sample all of whose rays are counted in one context.
inline void record(FilmHalf& half, Pixel pixel, const PartValues& sample, const PathContext& context) {
  if (context.log) context.log->add_rays(context.rays);
  record(half, pixel, sample, context.log);
}

}  // namespace gradslc
