#pragma once

#include <optional>

#include "materials/lobes.h"
#include "materials/lobes/fresnel_terms.h"

namespace gradslc {

/// Perfect mirror reflection times a Fresnel term.
template <class Fresnel>
struct SpecularReflection {
  Fresnel fresnel;
  Rgb reflectance{1};

  static constexpr bool k_delta = true;
  static constexpr bool k_transmits = false;
  static constexpr float roughness() { return k_delta_roughness; }

  std::optional<BsdfSample> sample(const Vec3& known, float /*u_choice*/, Vec2 /*u*/, Transport) const {
    if (!reflects(known)) return std::nullopt;
    return BsdfSample{{-known.x, -known.y, known.z}, energy(known), 1, true};
  }
  Rgb energy(const Vec3& known) const { return reflects(known) ? reflectance * fresnel(known.z) : Rgb(); }
  Rgb feature_albedo() const { return reflectance * fresnel(1); }

 private:
  static bool reflects(const Vec3& known) { return Fresnel::k_both_sides ? known.z != 0 : known.z > 0; }
};

using SmoothConductor = SpecularReflection<ConductorTerm>;
using SmoothCoat = SpecularReflection<CoatTerm>;
using ThinPaneReflection = SpecularReflection<ThinPaneTerm>;

}  // namespace gradslc
