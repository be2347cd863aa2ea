#pragma once

#include <algorithm>
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

/// How a microfacet lobe falls off around the mirror image of the known direction, relative to its facets' peak, for
/// s2 = sin^2(g/2), g the angle to that image, and alpha2 in (0, 1]. The half vector is inclined by g/2 or more (the
/// reflection at a plane inclined by t moves an image by 2 t at most), and GGX's d(t) / d(0) is 1 / (1 + sin^2(t)
/// (1/alpha^2 - 1))^2.
template <class Float>
Float gloss_falloff(Float s2, Float alpha2) {
  const Float root = alpha2 + s2 * (1 - alpha2);
  return alpha2 * alpha2 / (root * root);
}

/// A bound min(peak, tail * gloss_falloff()) that knows where a lobe points.
struct GlossBound {
  float peak = 0, tail = 0, alpha2 = 0;  ///< peak 0: nothing
  GlossBound& operator+=(const GlossBound& o) {
    peak += o.peak, tail += o.tail, alpha2 = std::max(alpha2, o.alpha2);
    return *this;
  }
  GlossBound scaled(float s) const { return {peak * s, tail * s, alpha2}; }
};

/// An upper bound over all directions w, for one known direction, of the largest channel:
///   pi f |cos_w| <= cosine |cos_w| + constant + gloss.
struct ReflectionBound {
  float cosine = 0, constant = 0;
  GlossBound gloss;
  ReflectionBound& operator+=(const ReflectionBound& o) {
    cosine += o.cosine, constant += o.constant, gloss += o.gloss;
    return *this;
  }
  ReflectionBound scaled(float s) const { return {cosine * s, constant * s, gloss.scaled(s)}; }
};

/// The same of the value alone: pi f <= broad + gloss.
struct ValueBound {
  float broad = 0;
  GlossBound gloss;
  float max() const { return broad + gloss.peak; }
};

}  // namespace gradslc
