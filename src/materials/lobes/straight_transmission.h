#pragma once

#include <optional>

#include "materials/lobes.h"
#include "materials/lobes/fresnel_terms.h"

namespace gradslc {

/// What passes straight through the surface: masks, null surfaces, thin panes. A crossing, DESIGN 2.
struct StraightTransmission {
  Rgb transmittance{1};
  float eta = 1;  ///< of a thin pane, whose reflection is taken off; 1: nothing is

  static constexpr bool k_delta = true;
  static constexpr bool k_transmits = true;
  static constexpr float roughness() { return k_delta_roughness; }

  std::optional<BsdfSample> sample(Vec3 known, float /*u_choice*/, Vec2 /*u*/, Transport) const {
    return BsdfSample{-known, energy(known), 1, true};
  }
  Rgb energy(Vec3 known) const {
    return eta == 1 ? transmittance : transmittance * (1 - thin_pane_reflectance(known.z, eta));
  }
  Rgb feature_albedo() const { return energy({0, 0, 1}); }
};

}  // namespace gradslc
