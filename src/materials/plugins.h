#pragma once
// The BSDF plug-ins: each is made from the properties of its element in a scene file, and some directly.

#include "materials/material.h"

namespace gradslc {

MaterialPtr make_diffuse(PropertyReader& properties);
MaterialPtr make_diffuse(Texture reflectance);

MaterialPtr make_conductor(PropertyReader& properties);
MaterialPtr make_mirror(Texture specular_reflectance);

MaterialPtr make_two_sided(PropertyReader& properties);
MaterialPtr make_two_sided(MaterialPtr front, MaterialPtr back);

MaterialPtr make_bump_map(PropertyReader& properties);
/// `scale` multiplies the heights.
MaterialPtr make_bump_map(MaterialPtr nested, Texture height, float scale);

MaterialPtr make_normal_map(PropertyReader& properties);
MaterialPtr make_normal_map(MaterialPtr nested, Texture normals);

}  // namespace gradslc
