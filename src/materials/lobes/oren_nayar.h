#pragma once

#include <optional>

#include "core/warp.h"
#include "materials/lobes.h"

namespace gradslc {

/// Rough diffuse reflection: V-shaped grooves of Lambertian facets (Oren and Nayar 1994), the full model with one
/// interreflection, or its qualitative form. Roughness as in Mitsuba: sigma = alpha / sqrt(2).
class OrenNayar {
 public:
  OrenNayar(Rgb albedo, float alpha, bool fast_approximation);

  static constexpr bool k_delta = false;
  static constexpr bool k_transmits = false;
  static constexpr float roughness() { return k_diffuse_roughness; }
  /// The model is unbounded where both directions graze; its tangents are kept below this, reached 0.06 degrees from
  /// the horizon.
  static constexpr float k_max_tangent = 1000;

  Rgb eval(const Vec3& wo, const Vec3& wi) const;
  std::optional<BsdfSample> sample(const Vec3& known, float u_choice, Vec2 u, Transport transport) const;
  float pdf_solid_angle(const Vec3& known, const Vec3& w) const {
    return known.z > 0 && w.z > 0 ? cosine_hemisphere_pdf_solid_angle(w.z) : 0;
  }
  Rgb energy(const Vec3& known) const { return known.z > 0 ? albedo_ : Rgb(); }
  ReflectionBound reflection_bound(const Vec3& known) const;
  float max_pi_f(const Vec3& known) const;
  Rgb feature_albedo() const { return albedo_; }

 private:
  Rgb albedo_;
  float c1_, c2_, c3_, c4_;  // as in the paper, without what depends on directions; c3, c4 are 0 in the fast form
};

}  // namespace gradslc
