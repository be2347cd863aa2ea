#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>
#include <variant>

#include "core/rgb.h"
#include "core/vec.h"
#include "materials/lobes.h"
#include "materials/lobes/coated_diffuse.h"
#include "materials/lobes/lambert.h"
#include "materials/lobes/microfacet_reflection.h"
#include "materials/lobes/oren_nayar.h"
#include "materials/lobes/rough_dielectric.h"
#include "materials/lobes/smooth_dielectric.h"
#include "materials/lobes/specular_reflection.h"

namespace gradslc {

/// One way in which a surface scatters. Every lobe has
///   k_delta       whether it scatters into discrete directions only,
///   k_transmits   whether it scatters to the other side of the surface,
///   roughness()   by which it is connectable or not,
///   sample(known, u_choice, u, transport)  as Bsdf::sample(); u_choice in [0,1) where it chooses within itself,
///   energy(known) approximate directional albedo per channel, 0 only where nothing is scattered, without eta^2,
///   feature_albedo() its colour, the feature of denoisers,
/// and, unless k_delta,
///   eval(wo, wi), pdf_solid_angle(known, w)  as in Bsdf,
///   reflection_bound(known)      of pi f |cos_w|,
///   max_pi_f(known)              an upper bound of pi f over the other direction, largest channel, finite,
///   gloss_bound(known)           where it has a peak: the same, by direction.
using Lobe = std::variant<Lambert, OrenNayar, SmoothCoatedDiffuse, RoughCoatedDiffuse, SmoothConductor, SmoothCoat,
                          ThinPaneReflection, SmoothDielectric, RoughConductor, RoughCoat, RoughDielectric>;

/// What the delta lobes do in one of the directions that they scatter into.
struct DeltaScattering {
  Vec3 direction;         ///< local, unit
  Rgb value;              ///< limit of f |cos| over the density of directions: a BsdfSample's weight times probability
  float probability = 0;  ///< with which sample() takes that direction, > 0
};

/// A BSDF at one surface point, its textures looked up: a plain value, the sum of its lobes. Directions are unit, in
/// the local frame whose +z is the shading normal, and point away from the surface: `wo` towards where light goes (the
/// camera), `wi` towards where it comes from. Every function takes the lobes that it speaks of (DESIGN 4:
/// f = f_c + f_s). Beside the lobes it has a share that passes straight through, which is no scattering and in none of
/// them: a crossing (DESIGN 2).
class Bsdf {
 public:
  static constexpr std::size_t k_max_lobes = 8;
  struct Entry {
    Lobe lobe;
    Rgb weight;       ///< factor of the lobe's f
    float roughness;  ///< the lobe's, asked for by every call

    template <class AnyLobe>
    Entry(const AnyLobe& of, Rgb factor) : lobe(of), weight(factor), roughness(of.roughness()) {}
  };
  /// f by the lobes that it comes from.
  struct Split {
    Rgb connectable, other;
  };

  /// At most k_max_lobes.
  template <class AnyLobe>
  void add(const AnyLobe& lobe, Rgb weight = Rgb(1)) {
    entries_.emplace_back(lobe, weight);
  }
  /// All lobes and the straight transmittance of another BSDF in the same frame, times `weight`.
  void add(const Bsdf& other, Rgb weight);
  void add_straight_transmittance(Rgb transmittance) { straight_transmittance_ += transmittance; }

  /// f, 1/sr, without the cosine, as radiance is scattered from wi to wo; 0 for delta lobes.
  Rgb eval(const Vec3& wo, const Vec3& wi, const LobeSelection& lobes) const;
  Split eval_split(const Vec3& wo, const Vec3& wi, const LobeSelection& lobes) const;
  /// Whether sample() uses `u_lobe`.
  bool chooses_lobes() const {
    return entries_.size() > 1 || (entries_.size() == 1 && !std::holds_alternative<Lambert>(entries_[0].lobe));
  }
  /// A direction for a known one; nullopt when nothing can be sampled. `u_lobe` in [0,1) chooses among lobes.
  std::optional<BsdfSample> sample(const Vec3& known, float u_lobe, Vec2 u, const LobeSelection& lobes,
                                   Transport transport = Transport::radiance) const;
  /// Density of sample(), 1/sr; 0 for delta lobes.
  float pdf_solid_angle(const Vec3& known, const Vec3& w, const LobeSelection& lobes) const;
  /// All that delta lobes reflect as mirrors do, or refract, when any lobe may be sampled; nullopt where there is
  /// nothing, or lobes refract into different directions.
  std::optional<DeltaScattering> delta(const Vec3& known, bool transmitted) const;
  /// Approximate directional albedo of the selected lobes, largest channel: what lobes are chosen by. 0 only where the
  /// lobes scatter nothing.
  float energy(const Vec3& known, const LobeSelection& lobes) const;
  /// Of the connectable lobes.
  ReflectionBound connectable_bound(const Vec3& known, const LobeSelection& lobes) const;
  /// Of the connectable lobes; its max() bounds pi f over the other direction, largest channel.
  ValueBound connectable_value_bound(const Vec3& known, const LobeSelection& lobes) const;
  /// Whether any of the selected lobes exists here, wherever light comes from.
  bool has(const LobeSelection& lobes) const;
  /// Whether any of the selected lobes scatters to the other side.
  bool transmits(const LobeSelection& lobes) const;
  /// Share of the light that passes straight through (masks, thin panes), in either sense along the direction that the
  /// surface was shaded for.
  Rgb straight_transmittance() const { return straight_transmittance_; }
  /// Probability with which a path that comes by `known`, the direction that the surface was shaded for, passes
  /// straight on instead of being scattered: in proportion to energy. 0 only where nothing passes.
  float pass_probability(const Vec3& known) const;
  /// pi f of the connectable lobes where that is the same for all directions on the known one's side: Lambertian
  /// ones only. nullopt elsewhere.
  std::optional<Rgb> lambert_albedo(const Vec3& known, const LobeSelection& lobes) const;
  /// Sum of the lobes' colours and of what passes straight through: the feature of denoisers.
  Rgb albedo() const;

  const auto& entries() const { return entries_; }

 private:
  /// sample() where there is one lobe, and it is selected.
  std::optional<BsdfSample> sample_only(const Vec3& known, float u_lobe, Vec2 u, Transport transport) const;

  boost::container::static_vector<Entry, k_max_lobes> entries_;
  Rgb straight_transmittance_;
};
static_assert(sizeof(Bsdf::Entry) <= 80, "BSDFs are copied for each hit");

}  // namespace gradslc
