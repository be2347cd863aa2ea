#pragma once

#include <optional>

#include "materials/fresnel.h"
#include "materials/lobes.h"

namespace gradslc {

/// Smooth conductor: perfect mirror reflection times Fresnel's reflectance. Material `none` (eta 0, k 1) reflects all.
struct SmoothConductor {
  Rgb eta, k;
  Rgb specular_reflectance{1};

  static constexpr bool k_delta = true;
  static constexpr bool k_transmits = false;
  static constexpr float roughness() { return k_delta_roughness; }

  std::optional<BsdfSample> sample(Vec3 known, float /*u_choice*/, Vec2 /*u*/, Transport) const {
    if (known.z <= 0) return std::nullopt;
    return BsdfSample{{-known.x, -known.y, known.z}, energy(known), 1, true};
  }
  Rgb energy(Vec3 known) const {
    return known.z > 0 ? specular_reflectance * fresnel_conductor(known.z, eta, k) : Rgb();
  }
  Rgb feature_albedo() const { return specular_reflectance; }
};

}  // namespace gradslc
