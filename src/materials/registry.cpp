#include "materials/material.h"
#include "materials/plugins.h"

namespace gradslc {
namespace {

constexpr BsdfEntry k_bsdfs[] = {
    {"diffuse", "Lambertian reflection", make_diffuse},
    {"roughdiffuse", "Oren and Nayar's rough diffuse reflection", make_rough_diffuse},
    {"conductor", "smooth conductor: mirror reflection with Fresnel's reflectance", make_conductor},
    {"roughconductor", "rough conductor: facets of a Beckmann or GGX surface", make_rough_conductor},
    {"dielectric", "smooth glass: mirror reflection and refraction", make_dielectric},
    {"thindielectric", "thin pane: mirror reflection and straight transmission", make_thin_dielectric},
    {"roughdielectric", "rough glass: reflecting and refracting facets", make_rough_dielectric},
    {"plastic", "diffuse base under a smooth dielectric coat", make_plastic},
    {"roughplastic", "diffuse base under a rough dielectric coat", make_rough_plastic},
    {"mask", "the BSDF inside times an opacity, straight transmission for the rest", make_mask},
    {"blendbsdf", "two BSDFs mixed by a weight", make_blend},
    {"twosided", "the BSDF inside, on both sides of the surface", make_two_sided},
    {"bumpmap", "the BSDF inside, under normals bent by the slopes of a height texture", make_bump_map},
    {"normalmap", "the BSDF inside, under the normals of a texture in the tangent frame", make_normal_map},
    {"null", "a surface that is not there", make_null},
};

}  // namespace

std::span<const BsdfEntry> bsdf_registry() { return k_bsdfs; }

}  // namespace gradslc
