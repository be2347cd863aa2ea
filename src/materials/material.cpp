#include "materials/material.h"

namespace gradslc {

Bsdf Material::resolve(Vec2 uv) const {
  if (const auto* diffuse = std::get_if<DiffuseMaterial>(&kind))
    return Bsdf(Diffuse{diffuse->reflectance.eval(uv)}, two_sided);
  const auto& conductor = std::get<ConductorMaterial>(kind);
  return Bsdf(Conductor{conductor.eta, conductor.k, conductor.specular_reflectance.eval(uv)}, two_sided);
}

bool Material::has_other_lobes(const LobeSelection& lobes) const {
  return std::holds_alternative<ConductorMaterial>(kind) && !lobes.is_connectable(k_delta_roughness);
}

float Material::max_connectable_albedo(const LobeSelection& lobes) const {
  const auto* diffuse = std::get_if<DiffuseMaterial>(&kind);
  return diffuse && lobes.is_connectable(k_diffuse_roughness) ? max_channel(diffuse->reflectance.max_value()) : 0;
}

}  // namespace gradslc
