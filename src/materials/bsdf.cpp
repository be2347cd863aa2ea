#include "materials/bsdf.h"

namespace gradslc {
namespace {

constexpr bool is_delta(const Bsdf::Lobe& lobe) { return std::holds_alternative<Conductor>(lobe); }

float roughness(const Bsdf::Lobe& lobe) {
  return std::visit([](const auto& l) { return l.roughness(); }, lobe);
}

Vec3 flip_side(Vec3 w) { return {w.x, w.y, -w.z}; }

}  // namespace

Rgb Bsdf::eval(Vec3 wo, Vec3 wi, const LobeSelection& lobes) const {
  if (is_delta(lobe_) || !lobes.includes(roughness(lobe_))) return Rgb();
  if (two_sided_ && wo.z < 0) wo = flip_side(wo), wi = flip_side(wi);
  return std::get<Diffuse>(lobe_).eval(wo, wi);
}

std::optional<BsdfSample> Bsdf::sample(Vec3 wo, float /*u_lobe*/, Vec2 u, const LobeSelection& lobes) const {
  if (!lobes.includes(roughness(lobe_))) return std::nullopt;
  const bool flipped = two_sided_ && wo.z < 0;
  if (flipped) wo = flip_side(wo);
  std::optional<BsdfSample> sample;
  if (const auto* diffuse = std::get_if<Diffuse>(&lobe_))
    sample = diffuse->sample(wo, u);
  else
    sample = std::get<Conductor>(lobe_).sample(wo);
  if (sample && flipped) sample->wi = flip_side(sample->wi);
  return sample;
}

float Bsdf::pdf_solid_angle(Vec3 wo, Vec3 wi, const LobeSelection& lobes) const {
  if (is_delta(lobe_) || !lobes.includes(roughness(lobe_))) return 0;
  if (two_sided_ && wo.z < 0) wo = flip_side(wo), wi = flip_side(wi);
  return std::get<Diffuse>(lobe_).pdf_solid_angle(wo, wi);
}

float Bsdf::energy(Vec3 wo, const LobeSelection& lobes) const {
  if (!lobes.includes(roughness(lobe_))) return 0;
  if (two_sided_ && wo.z < 0) wo = flip_side(wo);
  if (wo.z <= 0) return 0;
  if (const auto* diffuse = std::get_if<Diffuse>(&lobe_)) return max_channel(diffuse->albedo);
  return max_channel(std::get<Conductor>(lobe_).fresnel(wo.z));
}

bool Bsdf::has(const LobeSelection& lobes) const {
  if (!lobes.includes(roughness(lobe_))) return false;
  return !is_black(albedo());
}

Rgb Bsdf::albedo() const {
  if (const auto* diffuse = std::get_if<Diffuse>(&lobe_)) return diffuse->albedo;
  return std::get<Conductor>(lobe_).specular_reflectance;
}

Rgb Bsdf::lambert_albedo() const {
  if (const auto* diffuse = std::get_if<Diffuse>(&lobe_)) return diffuse->albedo;
  return Rgb();
}

float Bsdf::max_connectable_albedo(const LobeSelection& lobes) const {
  if (!lobes.connectable || !lobes.is_connectable(roughness(lobe_))) return 0;
  return max_channel(lambert_albedo());
}

}  // namespace gradslc
