#include "materials/lobes/rough_dielectric.h"

namespace gradslc {
namespace {

Vec3 outwards(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }

}  // namespace

RoughDielectric::Facet RoughDielectric::facet_between(const Vec3& known, const Vec3& w) const {
  const bool reflected = known.z * w.z > 0;
  const float eta_known = known.z > 0 ? 1 : eta, eta_w = w.z > 0 ? 1 : eta;
  const Vec3 sum = reflected ? known + w : eta_known * known + eta_w * w;
  const float squared = length_squared(sum);
  Facet facet{};
  if (!(squared > 0)) return facet;
  const float length = std::sqrt(squared);
  facet.h = sum / length;
  if (facet.h.z < 0) facet.h = -facet.h;
  facet.cos_known = reflected ? std::copysign(length / 2, known.z) : dot(known, facet.h);
  facet.cos_w = reflected ? facet.cos_known : dot(w, facet.h);
  if (facet.cos_known * known.z <= 0 || facet.cos_w * w.z <= 0) return facet;
  facet.density = microfacet.d(facet.h);
  const float cos_i = reflected || known.z > 0 ? facet.cos_known : facet.cos_w;  // refraction is seen from outside
  facet.reflectance = fresnel_dielectric(std::clamp(cos_i, -1.0f, 1.0f), eta).reflectance;
  facet.jacobian = reflected ? 1 / (4 * std::abs(facet.cos_w)) : eta_w * eta_w * std::abs(facet.cos_w) / squared;
  return facet;
}

float RoughDielectric::reflection_probability(float fresnel) const {
  const float reflected = fresnel * max_channel(reflectance), refracted = (1 - fresnel) * max_channel(transmittance);
  return reflected + refracted > 0 ? reflected / (reflected + refracted) : 0;
}

Rgb RoughDielectric::eval(const Vec3& wo, const Vec3& wi) const {
  if (wo.z == 0 || wi.z == 0) return Rgb();
  const Facet facet = facet_between(wi, wo);  // its jacobian is dh/dwo
  if (facet.density == 0) return Rgb();
  const Rgb colour = wo.z * wi.z > 0 ? reflectance * facet.reflectance : transmittance * (1 - facet.reflectance);
  return colour * (facet.density * microfacet.g1_over_cos(wi) * microfacet.g1_over_cos(wo) * std::abs(facet.cos_known) *
                   facet.jacobian);
}

float RoughDielectric::pdf_solid_angle(const Vec3& known, const Vec3& w) const {
  if (known.z == 0 || w.z == 0) return 0;
  const Facet facet = facet_between(known, w);
  if (facet.density == 0) return 0;
  const float p = reflection_probability(facet.reflectance);
  return (known.z * w.z > 0 ? p : 1 - p) * facet.density * microfacet.g1_over_cos(known) * std::abs(facet.cos_known) *
         facet.jacobian;
}

std::optional<BsdfSample> RoughDielectric::sample(const Vec3& known, float u_choice, Vec2 u,
                                                  Transport transport) const {
  if (known.z == 0) return std::nullopt;
  const Vec3 m = microfacet.sample_visible(known.z > 0 ? known : -known, u);
  const float cos_m = dot(known, m);
  if (cos_m * known.z <= 0) return std::nullopt;
  const DielectricFresnel fresnel = fresnel_dielectric(std::clamp(cos_m, -1.0f, 1.0f), eta);
  const float p = reflection_probability(fresnel.reflectance);
  const bool reflected = u_choice < p;
  if (!reflected && fresnel.reflectance == 1) return std::nullopt;
  const float bend = known.z > 0 ? 1 / eta : eta;  // index on known's side over index on the other
  const Vec3 w = reflected ? 2 * cos_m * m - known : (bend * cos_m + fresnel.cos_transmitted) * m - bend * known;
  if (reflected != (known.z * w.z > 0)) return std::nullopt;
  const float pdf = pdf_solid_angle(known, w);
  if (!(pdf > 0)) return std::nullopt;
  const float scale = !reflected && transport == Transport::radiance ? bend * bend : 1;
  const Rgb colour =
      reflected ? reflectance * (fresnel.reflectance / p) : transmittance * ((1 - fresnel.reflectance) / (1 - p));
  return BsdfSample{w, colour * (microfacet.g1(w) * scale), pdf, false};
}

Rgb RoughDielectric::energy(const Vec3& known) const {
  if (known.z == 0) return Rgb();
  // Where the surface reflects all, some facets let light pass.
  const float f = std::min(fresnel_dielectric(std::clamp(known.z, -1.0f, 1.0f), eta).reflectance, 0.99f);
  return reflectance * f + transmittance * (1 - f);
}

float RoughDielectric::max_refraction(float eta) {
  const float dense = std::max(eta, 1.0f), difference = eta - 1;
  return k_pi * dense * dense / (difference * difference);
}

float RoughDielectric::refraction(float cos_known, float ratio) const {
  const float cos2_other = 1 - (1 - cos_known * cos_known) * ratio * ratio;
  if (cos2_other <= 0) return 0;
  const float cos_other = std::sqrt(cos2_other), difference = ratio * cos_known - cos_other;
  const float dense = std::max(ratio, 1.0f);  // the larger index over that of the other side
  return k_pi * dense * dense * cos_known * cos_other / (difference * difference);
}

float RoughDielectric::refraction_bound(const Vec3& known, bool by_cosine) const {
  constexpr int rings = 8;
  constexpr float slopes[rings] = {0, 0.3f, 0.6f, 1, 1.5f, 2.2f, 3.5f, 7};  // over roughness
  const float wide = std::max(microfacet.alpha_u, microfacet.alpha_v);
  const float ratio = known.z > 0 ? 1 / eta : eta;
  const float theta = std::atan2(std::sqrt(known.x * known.x + known.y * known.y), std::abs(known.z));
  float largest = 0, low = 0;
  for (int i = 0; i < rings; ++i) {
    const float high = i + 1 < rings ? std::atan(wide * slopes[i + 1]) : k_pi / 2;
    float bound = microfacet.max_d(low) * refraction(std::cos(std::max(0.0f, theta - high)), ratio);
    if (!by_cosine) {
      const float sin_other = std::min(1.0f, ratio * std::sin(std::min(k_pi / 2, theta + high)));
      const float inclination = std::min(k_pi / 2, high + std::asin(sin_other));
      bound *= microfacet.max_g1_over_cos(1, std::max(std::cos(inclination), 0.0f));
    }
    largest = std::max(largest, bound);
    low = high;
  }
  return max_channel(transmittance) * largest * microfacet.g1_over_cos(known) * 1.0005f;
}

ReflectionBound RoughDielectric::reflection_bound(const Vec3& known) const {
  if (known.z == 0) return {};
  const ReflectionBound reflected = reflecting_side(known).reflection_bound(outwards(known));
  return {.cosine = 0, .constant = std::max(reflected.gloss.peak, refraction_bound(known, true))};
}

float RoughDielectric::max_pi_f(const Vec3& known) const {
  if (known.z == 0) return 0;
  return std::max(reflecting_side(known).max_pi_f(outwards(known)), refraction_bound(known, false));
}

}  // namespace gradslc
