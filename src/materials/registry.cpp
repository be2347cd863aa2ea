#include "materials/material.h"
#include "materials/plugins.h"

namespace gradslc {
namespace {

constexpr BsdfEntry k_bsdfs[] = {
    {"diffuse", "Lambertian reflection", make_diffuse},
    {"conductor", "smooth conductor: mirror reflection with Fresnel's reflectance", make_conductor},
    {"twosided", "the BSDF inside, on both sides of the surface", make_two_sided},
    {"bumpmap", "the BSDF inside, under normals bent by the slopes of a height texture", make_bump_map},
    {"normalmap", "the BSDF inside, under the normals of a texture in the tangent frame", make_normal_map},
};

}  // namespace

std::span<const BsdfEntry> bsdf_registry() { return k_bsdfs; }

}  // namespace gradslc
