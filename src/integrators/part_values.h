#pragma once

#include <array>

#include "core/rgb.h"
#include "film/film.h"

namespace gradslc {

/// Radiance split by how the light came (DESIGN 4).
struct PartValues {
  std::array<Rgb, k_part_count> values;

  Rgb& operator[](Part part) { return values[static_cast<std::size_t>(part)]; }
  const Rgb& operator[](Part part) const { return values[static_cast<std::size_t>(part)]; }
  Rgb total() const {
    Rgb sum;
    for (const Rgb& value : values) sum += value;
    return sum;
  }
  PartValues& operator+=(const PartValues& o) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += o.values[i];
    return *this;
  }
  PartValues& operator*=(float s) {
    for (Rgb& value : values) value *= s;
    return *this;
  }
};

}  // namespace gradslc
