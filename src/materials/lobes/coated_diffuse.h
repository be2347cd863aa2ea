#pragma once

#include <optional>

#include "core/warp.h"
#include "materials/fresnel.h"
#include "materials/lobes.h"
#include "materials/rough_transmittance.h"

namespace gradslc {

/// What a smooth dielectric coat lets pass, by the cosine outside.
struct SmoothCoatTransmittance {
  float eta;             ///< index inside over index outside, > 0
  float escaping_share;  ///< 1 - the reflectance for diffuse light from inside

  float operator()(float cos_theta) const { return 1 - fresnel_dielectric(cos_theta, eta).reflectance; }
  float max() const { return 1; }
  float escaping() const { return escaping_share; }
  float inv_eta2() const { return 1 / (eta * eta); }
};

/// What a rough one lets pass: a table that the material owns.
struct RoughCoatTransmittance {
  const RoughTransmittance* table;

  float operator()(float cos_theta) const { return (*table)(cos_theta); }
  float max() const { return table->max(); }
  float escaping() const { return table->escaping(); }
  float inv_eta2() const { return table->inv_eta2(); }
};

/// Diffuse base under a dielectric coat: f = base T(wi) T(wo) / (pi eta^2); `base` includes what the coat throws back
/// to the base (Mitsuba's plastic and roughplastic).
template <class Transmittance>
struct CoatedDiffuse {
  Transmittance transmittance;
  Rgb base;

  static constexpr bool k_delta = false;
  static constexpr bool k_transmits = false;
  static constexpr float roughness() { return k_diffuse_roughness; }

  Rgb eval(const Vec3& wo, const Vec3& wi) const {
    if (wo.z <= 0 || wi.z <= 0) return Rgb();
    return base * (k_inv_pi * transmittance.inv_eta2() * transmittance(wo.z) * transmittance(wi.z));
  }
  std::optional<BsdfSample> sample(const Vec3& known, float /*u_choice*/, Vec2 u, Transport) const {
    if (known.z <= 0) return std::nullopt;
    const Vec3 w = square_to_cosine_hemisphere(u);
    if (w.z <= 0) return std::nullopt;
    return BsdfSample{w, k_pi * eval(known, w), cosine_hemisphere_pdf_solid_angle(w.z), false};
  }
  float pdf_solid_angle(const Vec3& known, const Vec3& w) const {
    return known.z > 0 && w.z > 0 ? cosine_hemisphere_pdf_solid_angle(w.z) : 0;
  }
  Rgb energy(const Vec3& known) const {
    return known.z > 0 ? base * (transmittance(known.z) * transmittance.escaping()) : Rgb();
  }
  ReflectionBound reflection_bound(const Vec3& known) const { return {.cosine = max_pi_f(known), .constant = 0}; }
  float max_pi_f(const Vec3& known) const {
    if (known.z <= 0) return 0;
    return max_channel(base) * transmittance.inv_eta2() * transmittance(known.z) * transmittance.max();
  }
  Rgb feature_albedo() const { return energy({0, 0, 1}); }
};

using SmoothCoatedDiffuse = CoatedDiffuse<SmoothCoatTransmittance>;
using RoughCoatedDiffuse = CoatedDiffuse<RoughCoatTransmittance>;

}  // namespace gradslc
