#pragma once

#include <optional>

#include "materials/lobes.h"
#include "materials/lobes/fresnel_terms.h"
#include "materials/microfacet.h"

namespace gradslc {

/// Facets that reflect like mirrors (Torrance and Sparrow 1967; Walter et al. 2007, eq. 20), masking and shadowing
/// independent of each other as in Mitsuba; light that hits a second facet is lost.
template <class Fresnel>
struct MicrofacetReflection {
  Microfacet microfacet;
  Fresnel fresnel;
  Rgb reflectance{1};

  static constexpr bool k_delta = false;
  static constexpr bool k_transmits = false;
  float roughness() const { return microfacet.roughness(); }

  Rgb eval(const Vec3& wo, const Vec3& wi) const {
    if (wo.z <= 0 || wi.z <= 0) return Rgb();
    const Vec3 sum = wo + wi;
    const float twice_cos = length(sum);
    const float facets = microfacet.d(sum / twice_cos) * microfacet.g1_over_cos(wo) * microfacet.g1_over_cos(wi) / 4;
    return reflectance * fresnel(std::min(twice_cos / 2, 1.0f)) * facets;
  }
  std::optional<BsdfSample> sample(const Vec3& known, float /*u_choice*/, Vec2 u, Transport) const {
    if (known.z <= 0) return std::nullopt;
    const Vec3 m = microfacet.sample_visible(known, u);
    const float cos_m = dot(known, m);
    const Vec3 w = 2 * cos_m * m - known;
    const float pdf = pdf_solid_angle(known, w);
    if (!(pdf > 0)) return std::nullopt;
    const Rgb weight = reflectance * fresnel(std::clamp(cos_m, 0.0f, 1.0f)) * microfacet.g1(w);
    return BsdfSample{w, weight, pdf, false};
  }
  float pdf_solid_angle(const Vec3& known, const Vec3& w) const {
    if (known.z <= 0 || w.z <= 0) return 0;
    return microfacet.d(normalize(known + w)) * microfacet.g1_over_cos(known) / 4;
  }
  Rgb energy(const Vec3& known) const { return known.z > 0 ? reflectance * fresnel(std::min(known.z, 1.0f)) : Rgb(); }

  ReflectionBound reflection_bound(const Vec3& known) const {
    if (known.z <= 0) return {};
    const float theta = inclination(known);
    const float f = fresnel.max(std::cos((theta + k_pi / 2) / 2));  // h halves the angle between known and w
    const float peak = max_channel(reflectance) * f * facets(known);
    return {.cosine = 0, .constant = 0, .gloss = {peak, peak, microfacet.falloff_alpha2()}};
  }
  /// Off the peak the other direction may graze, where masking over cosine is large: the tail's factor.
  GlossBound gloss_bound(const Vec3& known) const {
    if (known.z <= 0) return {};
    const float f = fresnel.max(std::cos((inclination(known) + k_pi / 2) / 2));
    const float tail = max_channel(reflectance) * f * facets(known) * microfacet.max_g1_over_cos(0, 1);
    return {max_pi_f(known), tail, microfacet.falloff_alpha2()};
  }
  /// The normal half-way between directions of inclinations a and b is inclined by |a - b|/2 or more, so that facets
  /// are rarer where the other direction grazes: a bound for each ring of inclinations above known's.
  float max_pi_f(const Vec3& known) const {
    if (known.z <= 0) return 0;
    constexpr int rings = 8;
    const float theta = inclination(known), width = (k_pi / 2 - theta) / rings;
    float largest = microfacet.max_d(0) * microfacet.max_g1_over_cos(1, known.z) * fresnel.max(known.z);
    for (int i = 0; i < rings; ++i) {
      const float low = theta + static_cast<float>(i) * width, high = low + width;
      const float g = microfacet.max_g1_over_cos(std::cos(low), std::max(std::cos(high), 0.0f));
      const float f = fresnel.max(std::cos((theta + high) / 2));
      largest = std::max(largest, microfacet.max_d((low - theta) / 2) * g * f);
    }
    return k_pi / 4 * max_channel(reflectance) * microfacet.g1_over_cos(known) * largest * k_rounding;
  }
  Rgb feature_albedo() const { return reflectance * fresnel(1); }

 private:
  static constexpr float k_rounding = 1.0005f;  // of eval() and of these bounds, where facets are nearly smooth
  /// What all bounds by direction have in common: pi/4 times the facets' peak and the known direction's masking.
  float facets(const Vec3& known) const {
    return k_pi / 4 * microfacet.falloff_peak() * microfacet.g1_over_cos(known) * k_rounding;
  }
  static float inclination(const Vec3& w) { return std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }
};

using RoughConductor = MicrofacetReflection<ConductorTerm>;
using RoughCoat = MicrofacetReflection<CoatTerm>;

}  // namespace gradslc
