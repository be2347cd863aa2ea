#pragma once

#include <optional>

#include "core/warp.h"
#include "materials/lobes.h"

namespace gradslc {

/// Lambertian reflection: f = albedo / pi on the side of the normal.
struct Lambert {
  Rgb albedo;

  static constexpr bool k_delta = false;
  static constexpr bool k_transmits = false;
  static constexpr float roughness() { return k_diffuse_roughness; }

  Rgb eval(const Vec3& wo, const Vec3& wi) const { return wo.z > 0 && wi.z > 0 ? albedo * k_inv_pi : Rgb(); }
  std::optional<BsdfSample> sample(const Vec3& known, float /*u_choice*/, Vec2 u, Transport) const {
    if (known.z <= 0) return std::nullopt;
    const Vec3 w = square_to_cosine_hemisphere(u);
    if (w.z <= 0) return std::nullopt;
    return BsdfSample{w, albedo, cosine_hemisphere_pdf_solid_angle(w.z), false};
  }
  float pdf_solid_angle(const Vec3& known, const Vec3& w) const {
    return known.z > 0 && w.z > 0 ? cosine_hemisphere_pdf_solid_angle(w.z) : 0;
  }
  Rgb energy(const Vec3& known) const { return known.z > 0 ? albedo : Rgb(); }
  ReflectionBound reflection_bound(const Vec3& known) const {
    return {.cosine = known.z > 0 ? max_channel(albedo) : 0, .constant = 0};
  }
  float max_pi_f(const Vec3& known) const { return known.z > 0 ? max_channel(albedo) : 0; }
  Rgb feature_albedo() const { return albedo; }
};

}  // namespace gradslc
