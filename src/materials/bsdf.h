#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "core/rgb.h"
#include "core/vec.h"
#include "materials/conductor.h"
#include "materials/diffuse.h"
#include "materials/lobes.h"

namespace gradslc {

/// A BSDF at one surface point, its textures looked up: a plain value. Directions are unit, in the local frame whose +z
/// is the shading normal, and point away from the surface: `wo` towards where light goes (the camera), `wi` towards
/// where it comes from. Every function takes the lobes that it speaks of (DESIGN 4: f = f_c + f_s).
class Bsdf {
 public:
  using Lobe = std::variant<Diffuse, Conductor>;
  Bsdf() = default;
  Bsdf(Lobe lobe, bool two_sided) : lobe_(lobe), two_sided_(two_sided) {}

  /// f, 1/sr, without the cosine; 0 for delta lobes.
  Rgb eval(Vec3 wo, Vec3 wi, const LobeSelection& lobes) const;
  /// A direction wi; nullopt when nothing can be sampled. `u_lobe` in [0,1) chooses among lobes.
  std::optional<BsdfSample> sample(Vec3 wo, float u_lobe, Vec2 u, const LobeSelection& lobes) const;
  /// Density of sample(), 1/sr; 0 for delta lobes.
  float pdf_solid_angle(Vec3 wo, Vec3 wi, const LobeSelection& lobes) const;
  /// Approximate directional albedo of the selected lobes, largest channel, in [0,1]: what lobes are chosen by. 0 only
  /// where the lobes reflect nothing.
  float energy(Vec3 wo, const LobeSelection& lobes) const;
  /// An upper bound of pi f per channel's maximum over all directions for the connectable lobes.
  float max_connectable_albedo(const LobeSelection& lobes) const;
  /// Whether any of the selected lobes exists here, wherever light comes from.
  bool has(const LobeSelection& lobes) const;
  /// Diffuse albedo or specular reflectance: the feature of denoisers.
  Rgb albedo() const;
  /// pi f of the connectable lobe where that is Lambert: constant over directions of one side.
  Rgb lambert_albedo() const;

 private:
  Lobe lobe_;
  bool two_sided_ = false;
};

}  // namespace gradslc
