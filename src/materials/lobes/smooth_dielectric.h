#pragma once

#include <optional>

#include "materials/lobes.h"
#include "materials/lobes/fresnel_terms.h"

namespace gradslc {

/// Smooth interface between dielectrics: mirror reflection and refraction, one of them chosen by what it carries.
struct SmoothDielectric {
  float eta;  ///< index inside over index outside, > 0
  Rgb reflectance{1}, transmittance{1};

  static constexpr bool k_delta = true;
  static constexpr bool k_transmits = true;
  static constexpr float roughness() { return k_delta_roughness; }

  std::optional<BsdfSample> sample(const Vec3& known, float u_choice, Vec2 /*u*/, Transport transport) const {
    if (known.z == 0) return std::nullopt;
    const DielectricFresnel fresnel = fresnel_dielectric(known.z, eta);
    const Rgb reflected = reflectance * fresnel.reflectance, refracted = transmittance * (1 - fresnel.reflectance);
    const float total = max_channel(reflected) + max_channel(refracted);
    if (total == 0) return std::nullopt;
    const float probability = max_channel(reflected) / total;
    if (u_choice < probability)
      return BsdfSample{{-known.x, -known.y, known.z}, reflected / probability, probability, true};
    const float bend = known.z > 0 ? 1 / eta : eta;  // index on known's side over index on the other
    const float scale = transport == Transport::radiance ? bend * bend : 1;
    return BsdfSample{{-bend * known.x, -bend * known.y, fresnel.cos_transmitted},
                      refracted * (scale / (1 - probability)),
                      1 - probability,
                      true};
  }
  Rgb energy(const Vec3& known) const {
    if (known.z == 0) return Rgb();
    const float f = fresnel_dielectric(known.z, eta).reflectance;
    return reflectance * f + transmittance * (1 - f);
  }
  Rgb feature_albedo() const { return energy({0, 0, 1}); }
};

}  // namespace gradslc
