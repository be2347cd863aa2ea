#include "materials/material.h"

namespace gradslc {
namespace {

Material make_diffuse(PropertyReader& properties) {
  return {.name = {}, .kind = DiffuseMaterial{properties.texture("reflectance", Rgb(0.5f))}, .two_sided = false};
}

Material make_conductor(PropertyReader& properties) {
  ConductorMaterial conductor;
  const std::string preset = properties.text("material", "");
  if (!preset.empty() && preset != "none")
    properties.fail("material", "only material \"none\" (a perfect mirror) is known; give eta and k instead");
  const bool mirror = preset == "none";
  conductor.eta = properties.colour("eta", mirror ? Rgb(0.0f) : Rgb(0.2004f, 0.9240f, 1.1022f));  // copper
  conductor.k = properties.colour("k", mirror ? Rgb(1.0f) : Rgb(3.9129f, 2.4528f, 2.1421f));
  conductor.specular_reflectance = properties.texture("specular_reflectance", Rgb(1.0f));
  return {.name = {}, .kind = conductor, .two_sided = false};
}

Material make_two_sided(PropertyReader& properties) {
  std::vector<Material> nested = properties.nested_materials();
  if (nested.size() != 1) properties.fail("", "a twosided bsdf needs exactly one bsdf inside");
  nested[0].two_sided = true;
  return nested[0];
}

constexpr BsdfEntry k_bsdfs[] = {
    {"diffuse", "Lambertian reflection", make_diffuse},
    {"conductor", "smooth conductor: mirror reflection with Fresnel's reflectance", make_conductor},
    {"twosided", "the BSDF inside, on both sides of the surface", make_two_sided},
};

}  // namespace

std::span<const BsdfEntry> bsdf_registry() { return k_bsdfs; }

}  // namespace gradslc
