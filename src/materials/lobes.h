#pragma once

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

/// A sampled direction.
struct BsdfSample {
  Vec3 wi;                    ///< local frame, unit
  Rgb weight;                 ///< f |cos| / pdf; for delta lobes the limit of it
  float pdf_solid_angle = 0;  ///< 1/sr, of all lobes asked for; for delta lobes the discrete probability, only a flag
  bool delta = false;         ///< cannot be connected to, has no density
};

}  // namespace gradslc
