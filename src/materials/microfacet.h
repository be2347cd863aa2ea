#pragma once

#include <cstdint>

#include "core/vec.h"

namespace gradslc {

enum class MicrofacetType : std::uint8_t { beckmann, ggx };

/// Distribution of the normals of a rough surface's facets, with Smith's masking (Walter et al. 2007; anisotropic as in
/// Heitz 2014, "Understanding the Masking-Shadowing Function"). Local frame: +z is the macroscopic normal, roughness
/// alpha_u along x and alpha_v along y.
struct Microfacet {
  MicrofacetType type = MicrofacetType::beckmann;
  float alpha_u = 0.1f, alpha_v = 0.1f;  ///< at least k_min_alpha

  static constexpr float k_min_alpha = 1e-4f;
  /// With alphas raised to k_min_alpha, as Mitsuba does.
  static Microfacet make(MicrofacetType type, float alpha_u, float alpha_v);

  /// The sharper one of both directions.
  float roughness() const { return std::min(alpha_u, alpha_v); }
  /// Density of facets by their normal m (unit), 1/sr: the integral of d(m) m.z is 1.
  float d(const Vec3& m) const;
  /// Smith's masking for a unit direction v, divided by |v.z|: finite at grazing angles. Same for both sides.
  float g1_over_cos(const Vec3& v) const;
  float g1(const Vec3& v) const { return g1_over_cos(v) * std::abs(v.z); }
  /// A normal of the facets that are seen from v (unit, v.z > 0); `u` in [0,1)^2.
  Vec3 sample_visible(const Vec3& v, Vec2 u) const;
  /// Density of sample_visible(), 1/sr.
  float visible_pdf_solid_angle(const Vec3& v, const Vec3& m) const;

  /// Upper bound of d() for all normals that are inclined by `theta` in [0, pi/2] or more.
  float max_d(float theta) const;
  /// d(m) <= falloff_peak() gloss_falloff(sin^2(inclination of m), falloff_alpha2()).
  float falloff_alpha2() const;
  float falloff_peak() const;
  /// Upper bound of g1_over_cos() for all directions of inclinations between both, given by their cosines.
  float max_g1_over_cos(float cos_a, float cos_b) const;
};

}  // namespace gradslc
