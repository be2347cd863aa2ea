#pragma once

#include <cstdint>

#include "core/constants.h"
#include "core/rgb.h"
#include "core/vec.h"

namespace gradslc {

/// Roughness alpha of a lobe for the split below: 0 for delta lobes, infinite for diffuse ones.
constexpr float k_delta_roughness = 0;
constexpr float k_diffuse_roughness = k_infinity;

/// Which lobes of a BSDF a call means. DESIGN 4 splits f = f_c + f_s: f_c are the connectable lobes, whose roughness is
/// at least the threshold; f_s the others (delta, sharper gloss).
struct LobeSelection {
  bool connectable = true, other = true;
  float connectable_roughness = 0.1f;  ///< vpl.connectable_roughness, > 0

  constexpr bool is_connectable(float roughness) const { return roughness >= connectable_roughness; }
  constexpr bool includes(float roughness) const { return is_connectable(roughness) ? connectable : other; }
  constexpr LobeSelection only_connectable() const { return {true, false, connectable_roughness}; }
  constexpr LobeSelection only_other() const { return {false, true, connectable_roughness}; }
};

/// What is carried along a path decides which direction of a BSDF f(wo, wi) is known when the other is sampled:
/// wo for radiance (paths from the camera), wi for particles (paths from the emitters; Veach 1997, section 3.7.6).
/// f itself is the same for both, and not symmetric where light is refracted.
enum class Transport : std::uint8_t { radiance, particles };

/// A sampled direction.
struct BsdfSample {
  Vec3 direction;             ///< local frame, unit; wi for radiance, wo for particles
  Rgb weight;                 ///< f |cos| / pdf, the cosine of `direction`; for delta lobes the limit of it
  float pdf_solid_angle = 0;  ///< 1/sr, of all lobes asked for; for delta lobes the discrete probability, only a flag
  bool delta = false;         ///< cannot be connected to, has no density
};

/// An upper bound over all directions w, for one known direction: pi f |cos_w| <= cosine |cos_w| + constant, of the
/// largest channel.
struct ReflectionBound {
  float cosine = 0, constant = 0;
  ReflectionBound& operator+=(const ReflectionBound& o) {
    cosine += o.cosine, constant += o.constant;
    return *this;
  }
};

}  // namespace gradslc
