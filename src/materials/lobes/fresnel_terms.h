#pragma once
// What mirrors and facets reflect, by the cosine of the angle to their normal: the term that reflecting lobes are made
// with.

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"

namespace gradslc {

/// Conductor: index eta + i k, relative to the outside; eta 0 reflects all (material `none`).
struct ConductorTerm {
  Rgb eta, k;

  static constexpr bool k_both_sides = false;
  Rgb operator()(float cos_theta) const { return fresnel_conductor(cos_theta, eta, k); }
  /// Upper bound for all cosines from the given one to 1.
  float max(float /*cos_theta*/) const { return 1; }
};

/// The outside of a dielectric coat.
struct CoatTerm {
  float eta;  ///< index inside over index outside, > 0

  static constexpr bool k_both_sides = false;
  Rgb operator()(float cos_theta) const { return Rgb(fresnel_dielectric(std::abs(cos_theta), eta).reflectance); }
  /// The reflectance rises towards grazing angles; where eta > 3.7 it falls first.
  float max(float cos_theta) const {
    return std::max(fresnel_dielectric(cos_theta, eta).reflectance, fresnel_dielectric(1, eta).reflectance);
  }
};

/// Thin pane of a dielectric, all reflections inside it included: R + T^2 R + T^2 R^3 ... = 2R / (1 + R).
inline float thin_pane_reflectance(float cos_theta, float eta) {
  const float r = fresnel_dielectric(std::abs(cos_theta), eta).reflectance;
  return 2 * r / (1 + r);
}

struct ThinPaneTerm {
  float eta;  ///< as CoatTerm's

  static constexpr bool k_both_sides = true;
  Rgb operator()(float cos_theta) const { return Rgb(thin_pane_reflectance(cos_theta, eta)); }
};

}  // namespace gradslc
