#pragma once

#include "film/film.h"
#include "integrators/part_values.h"

namespace gradslc {

/// Adds one sample of a pixel to a half of the film: the whole, and the parts where the film keeps them.
inline void record(FilmHalf& half, Pixel pixel, const PartValues& sample) {
  half.primal.add(pixel, sample.total());
  for (std::size_t part = 0; part < half.part_sums.size(); ++part) half.part_sums[part][pixel] += sample.values[part];
}

}  // namespace gradslc
