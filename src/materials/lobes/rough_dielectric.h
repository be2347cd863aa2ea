#pragma once

#include <optional>

#include "materials/lobes.h"
#include "materials/lobes/fresnel_terms.h"
#include "materials/lobes/microfacet_reflection.h"
#include "materials/microfacet.h"

namespace gradslc {

/// Rough interface between dielectrics: facets that reflect and refract (Walter et al. 2007), masking and shadowing
/// independent of each other as in Mitsuba; light that hits a second facet is lost. f(wo, wi) of the refraction scales
/// radiance by eta^2 of wo's side over that of wi's: f(wo, wi) / eta_o^2 is symmetric.
struct RoughDielectric {
  Microfacet microfacet;
  float eta;  ///< index inside over index outside, > 0, not 1
  Rgb reflectance{1}, transmittance{1};

  static constexpr bool k_delta = false;
  static constexpr bool k_transmits = true;
  float roughness() const { return microfacet.roughness(); }

  Rgb eval(const Vec3& wo, const Vec3& wi) const;
  std::optional<BsdfSample> sample(const Vec3& known, float u_choice, Vec2 u, Transport transport) const;
  float pdf_solid_angle(const Vec3& known, const Vec3& w) const;
  Rgb energy(const Vec3& known) const;
  ReflectionBound reflection_bound(const Vec3& known) const;
  float max_pi_f(const Vec3& known) const;
  Rgb feature_albedo() const { return energy({0, 0, 1}); }

  /// Upper bound of refraction() for all angles: where facets are hit straight.
  static float max_refraction(float eta);

 private:
  struct Facet {
    Vec3 h;                  // on the outside
    float density;           // d(h), 0 where one of the directions sees its back
    float cos_known, cos_w;  // with h
    float reflectance;       // Fresnel's
    float jacobian;          // dh/dw
  };
  Facet facet_between(const Vec3& known, const Vec3& w) const;
  float reflection_probability(float fresnel) const;
  /// Upper bound of pi times what pi f of the refraction has beside D, G1 / cos and G1 / cos: eta_o^2 |wi.h| |wo.h|
  /// over the square of (eta_i wi.h + eta_o wo.h), which grows with |known.h|. `ratio`: index on known's side over the
  /// other.
  float refraction(float cos_known, float ratio) const;
  /// Upper bound of pi f, or of pi f |cos_w|, of the refraction: the largest of those for rings of facets by their
  /// inclination, of which the steeper are rarer, but may be hit straighter.
  float refraction_bound(const Vec3& known, bool by_cosine) const;
  /// The interface as those who are on known's side see it, without what it lets pass.
  RoughCoat reflecting_side(const Vec3& known) const {
    return {microfacet, {known.z > 0 ? eta : 1 / eta}, reflectance};
  }
};

}  // namespace gradslc
