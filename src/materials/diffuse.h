#pragma once

#include <optional>

#include "core/warp.h"
#include "materials/lobes.h"

namespace gradslc {

/// Lambertian reflection: f = albedo / pi on the side of the normal.
struct Diffuse {
  Rgb albedo;

  static constexpr float roughness() { return k_diffuse_roughness; }

  Rgb eval(Vec3 wo, Vec3 wi) const { return wo.z > 0 && wi.z > 0 ? albedo * k_inv_pi : Rgb(); }
  std::optional<BsdfSample> sample(Vec3 wo, Vec2 u) const {
    if (wo.z <= 0) return std::nullopt;
    const Vec3 wi = square_to_cosine_hemisphere(u);
    if (wi.z <= 0) return std::nullopt;
    return BsdfSample{wi, albedo, cosine_hemisphere_pdf_solid_angle(wi.z), false};
  }
  float pdf_solid_angle(Vec3 wo, Vec3 wi) const {
    return wo.z > 0 && wi.z > 0 ? cosine_hemisphere_pdf_solid_angle(wi.z) : 0;
  }
};

}  // namespace gradslc
