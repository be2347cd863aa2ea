#include "materials/material.h"
#include "materials/plugins.h"

namespace gradslc {
namespace {

constexpr BsdfEntry k_bsdfs[] = {
    {"diffuse", "Lambertian reflection", make_diffuse},
    {"conductor", "smooth conductor: mirror reflection with Fresnel's reflectance", make_conductor},
    {"twosided", "the BSDF inside, on both sides of the surface", make_two_sided},
};

}  // namespace

std::span<const BsdfEntry> bsdf_registry() { return k_bsdfs; }

}  // namespace gradslc
