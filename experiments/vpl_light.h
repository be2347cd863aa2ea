#pragma once

#include "film/film.h"

namespace gradslc {

/// The light that VPLs can represent: parts vpl + compensation, which spt writes as one. Of a film with parts.
inline RgbImage vpl_light(const Film& film) {
  RgbImage sum = film.part(Part::vpl);
  const RgbImage compensation = film.part(Part::compensation);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += compensation[i];
  return sum;
}

}  // namespace gradslc
