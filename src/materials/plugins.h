#pragma once
// The BSDF plug-ins: each is made from the properties of its element in a scene file, and some directly.

#include "materials/material.h"

namespace gradslc {

MaterialPtr make_diffuse(PropertyReader& properties);
MaterialPtr make_diffuse(Texture reflectance);

MaterialPtr make_rough_diffuse(PropertyReader& properties);

MaterialPtr make_conductor(PropertyReader& properties);
MaterialPtr make_mirror(Texture specular_reflectance);

MaterialPtr make_rough_conductor(PropertyReader& properties);
MaterialPtr make_rough_mirror(MicrofacetType type, float alpha, Texture specular_reflectance);

/// `eta` here and below: index of refraction inside over the one outside, > 0.
MaterialPtr make_dielectric(PropertyReader& properties);
MaterialPtr make_dielectric(float eta);
MaterialPtr make_thin_dielectric(PropertyReader& properties);
MaterialPtr make_thin_dielectric(float eta);
MaterialPtr make_rough_dielectric(PropertyReader& properties);
MaterialPtr make_rough_dielectric(MicrofacetType type, float alpha, float eta);

MaterialPtr make_plastic(PropertyReader& properties);
MaterialPtr make_plastic(float eta, Texture diffuse_reflectance, bool nonlinear);
MaterialPtr make_rough_plastic(PropertyReader& properties);
MaterialPtr make_rough_plastic(MicrofacetType type, float alpha, float eta, Texture diffuse_reflectance,
                               bool nonlinear);

MaterialPtr make_null(PropertyReader& properties);
MaterialPtr make_mask(PropertyReader& properties);
MaterialPtr make_mask(Texture opacity, MaterialPtr nested);
MaterialPtr make_blend(PropertyReader& properties);

MaterialPtr make_two_sided(PropertyReader& properties);
MaterialPtr make_two_sided(MaterialPtr front, MaterialPtr back);

MaterialPtr make_bump_map(PropertyReader& properties);
/// `scale` multiplies the heights.
MaterialPtr make_bump_map(MaterialPtr nested, Texture height, float scale);

MaterialPtr make_normal_map(PropertyReader& properties);
MaterialPtr make_normal_map(MaterialPtr nested, Texture normals);

}  // namespace gradslc
