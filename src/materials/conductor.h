#pragma once

#include <optional>

#include "materials/lobes.h"

namespace gradslc {

/// Fresnel reflectance of an interface with a conductor, unpolarised, exact: `eta`, `k` relative to the outside.
/// `cos_theta` in [0,1] (Born and Wolf 1999, section 14.2).
float fresnel_conductor(float cos_theta, float eta, float k);

/// Smooth conductor: perfect mirror reflection times Fresnel's reflectance. Material `none` (eta 0, k 1) reflects all.
struct Conductor {
  Rgb eta, k;
  Rgb specular_reflectance{1};

  static constexpr float roughness() { return k_delta_roughness; }

  Rgb fresnel(float cos_theta) const;
  std::optional<BsdfSample> sample(Vec3 wo) const {
    if (wo.z <= 0) return std::nullopt;
    return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel(wo.z), 1, true};
  }
};

}  // namespace gradslc
