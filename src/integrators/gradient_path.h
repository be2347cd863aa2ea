#pragma once

#include <span>

#include "integrators/offset_path.h"

namespace gradslc {

/// A base path and its offsets, through neighbouring pixels.
struct GradientPathContext {
  PathContext& base;          ///< its random numbers are those of all paths
  PathContext& offsets;       ///< counts their rays
  LobeSelection lobes;        ///< all, split at the roughness by which vertices are connectable
  bool shifts_seen_emission;  ///< else D = 1 has no offsets: its difference is that of the base paths
};

/// Follows a path from the camera to its end as trace_path() does, without Russian roulette, and has the offset paths
/// follow it, which are started. Adds the base's light to `radiance`; the offsets keep their differences.
template <class Throughput>
void trace_gradient_path(const GradientPathContext& context, const Ray& camera_ray, std::span<OffsetPath> offsets,
                         PartValues& radiance);

}  // namespace gradslc
