#include "unit/materials/bsdf_cases.h"

#include <ostream>

#include "materials/plugins.h"
#include "unit/materials/fake_properties.h"

namespace gradslc {
namespace {

const Texture k_grey{Rgb(0.2f, 0.5f, 0.8f)};
const Texture k_white{Rgb(1)};

FakeProperties facets(const char* distribution, float alpha_u, float alpha_v) {
  FakeProperties properties;
  properties.texts["distribution"] = distribution;
  properties.reals["alpha_u"] = alpha_u;
  properties.reals["alpha_v"] = alpha_v;
  return properties;
}

MaterialPtr rough_diffuse(float alpha, bool fast) {
  FakeProperties properties;
  properties.textures["reflectance"] = k_grey;
  properties.reals["alpha"] = alpha;
  properties.booleans["use_fast_approx"] = fast;
  return make_plugin("roughdiffuse", properties);
}

MaterialPtr rough_conductor(const char* distribution, float alpha_u, float alpha_v) {
  return make_plugin("roughconductor", facets(distribution, alpha_u, alpha_v));
}

MaterialPtr rough_dielectric(const char* distribution, float alpha_u, float alpha_v) {
  FakeProperties properties = facets(distribution, alpha_u, alpha_v);
  properties.colours["specular_transmittance"] = Rgb(0.9f, 0.7f, 0.5f);
  return make_plugin("roughdielectric", properties);
}

MaterialPtr rough_glass_without_reflection() {
  FakeProperties properties = facets("ggx", 0.3f, 0.3f);
  properties.reals["specular_reflectance"] = 0;
  return make_plugin("roughdielectric", properties);
}

MaterialPtr tinted_glass() {
  FakeProperties properties;
  properties.colours["specular_reflectance"] = Rgb(0.3f, 0.5f, 0.9f);
  properties.colours["specular_transmittance"] = Rgb(0.8f, 0.2f, 0.4f);
  properties.texts["int_ior"] = "water";
  return make_plugin("dielectric", properties);
}

MaterialPtr blend(MaterialPtr first, MaterialPtr second) {
  FakeProperties properties;
  properties.nested = {std::move(first), std::move(second)};
  properties.reals["weight"] = 0.3f;
  return make_plugin("blendbsdf", properties);
}

constexpr float k_bk7 = 1.5046f / 1.000277f;

}  // namespace

void PrintTo(const BsdfCase& c, std::ostream* stream) { *stream << c.name; }

std::vector<BsdfCase> bsdf_cases() {
  const auto ggx = MicrofacetType::ggx, beckmann = MicrofacetType::beckmann;
  const MaterialPtr rough_plastic = make_rough_plastic(ggx, 0.2f, 1.5f, k_grey, true);
  return {
      {"diffuse_grey", "diffuse", make_diffuse(k_grey)},
      {"diffuse_white", "diffuse", make_diffuse(k_white), {.white = true}},
      {"rough_diffuse", "roughdiffuse", rough_diffuse(0.3f, false)},
      {"rough_diffuse_fast", "roughdiffuse", rough_diffuse(0.7f, true)},
      {"conductor_copper", "conductor", make_plugin("conductor")},
      {"conductor_mirror", "conductor", make_mirror(k_white), {.white = true}},
      {"rough_conductor_beckmann_005", "roughconductor", rough_conductor("beckmann", 0.05f, 0.05f)},
      {"rough_conductor_beckmann_03_06", "roughconductor", rough_conductor("beckmann", 0.3f, 0.6f)},
      {"rough_conductor_ggx_01", "roughconductor", rough_conductor("ggx", 0.1f, 0.1f)},
      {"rough_conductor_ggx_04_01", "roughconductor", rough_conductor("ggx", 0.4f, 0.1f)},
      {"rough_mirror_ggx_03", "roughconductor", make_rough_mirror(ggx, 0.3f, k_white)},
      {"rough_mirror_beckmann_1", "roughconductor", make_rough_mirror(beckmann, 1, k_white)},
      {"glass",
       "dielectric",
       make_dielectric(1.5f),
       {.both_sides = true, .transmits = true, .white = true, .eta = 1.5f}},
      {"air_in_glass",
       "dielectric",
       make_dielectric(0.67f),
       {.both_sides = true, .transmits = true, .white = true, .eta = 0.67f}},
      {"tinted_water",
       "dielectric",
       tinted_glass(),
       {.both_sides = true, .transmits = true, .eta = 1.333f / 1.000277f}},
      {"pane", "thindielectric", make_thin_dielectric(1.5f), {.both_sides = true, .transmits = true, .white = true}},
      {"rough_glass_ggx_01",
       "roughdielectric",
       make_rough_dielectric(ggx, 0.1f, 1.5f),
       {.both_sides = true, .transmits = true, .eta = 1.5f}},
      {"rough_air_in_glass_ggx_04",
       "roughdielectric",
       make_rough_dielectric(ggx, 0.4f, 0.67f),
       {.both_sides = true, .transmits = true, .eta = 0.67f}},
      {"rough_tinted_glass_beckmann_03",
       "roughdielectric",
       rough_dielectric("beckmann", 0.3f, 0.3f),
       {.both_sides = true, .transmits = true, .eta = k_bk7}},
      {"rough_tinted_glass_ggx_02_05",
       "roughdielectric",
       rough_dielectric("ggx", 0.2f, 0.5f),
       {.both_sides = true, .transmits = true, .eta = k_bk7}},
      {"rough_glass_without_reflection",
       "roughdielectric",
       rough_glass_without_reflection(),
       {.both_sides = true, .transmits = true, .eta = k_bk7}},
      {"plastic", "plastic", make_plastic(1.5f, k_grey, false)},
      {"plastic_nonlinear", "plastic", make_plastic(1.9f, k_grey, true)},
      {"rough_plastic_ggx_005", "roughplastic", make_rough_plastic(ggx, 0.05f, 1.5f, k_grey, false)},
      {"rough_plastic_ggx_02", "roughplastic", rough_plastic},
      {"rough_plastic_beckmann_05", "roughplastic", make_rough_plastic(beckmann, 0.5f, 1.3f, k_grey, true)},
      {"two_sided_diffuse",
       "twosided",
       make_two_sided(make_diffuse(k_grey), make_diffuse(k_grey)),
       {.both_sides = true}},
      {"two_sided_mirror_diffuse",
       "twosided",
       make_two_sided(make_mirror(k_white), make_diffuse(k_white)),
       {.both_sides = true, .white = true}},
      {"two_sided_rough_plastic", "twosided", make_two_sided(rough_plastic, rough_plastic), {.both_sides = true}},
      {"mask_diffuse",
       "mask",
       make_mask(Texture(Rgb(0.4f)), make_diffuse(k_white)),
       {.both_sides = true, .transmits = true}},
      {"mask_coloured",
       "mask",
       make_mask(Texture(Rgb(0.9f, 0, 0.3f)), make_two_sided(rough_plastic, make_mirror(k_grey))),
       {.both_sides = true, .transmits = true}},
      {"bump_map_rough_plastic", "bumpmap", make_bump_map(rough_plastic, k_grey, 1)},
      {"normal_map_pane",
       "normalmap",
       make_normal_map(make_thin_dielectric(1.5f), Texture(Rgb(0.5f, 0.5f, 1))),
       {.both_sides = true, .transmits = true, .white = true}},
      {"blend_diffuse_copper", "blendbsdf", blend(make_diffuse(k_grey), rough_conductor("ggx", 0.2f, 0.2f))},
      {"blend_pane_plastic",
       "blendbsdf",
       blend(make_thin_dielectric(1.5f), rough_plastic),
       {.both_sides = true, .transmits = true}},
      {"null", "null", make_plugin("null"), {.both_sides = true, .transmits = true, .white = true}},
  };
}

Vec3 mirrored_side(Vec3 w) { return {w.x, w.y, -w.z}; }

std::vector<Vec3> known_directions() {
  std::vector<Vec3> directions;
  for (const Vec3 w : {Vec3{0.01f, 0, 1}, Vec3{0.5f, 0.2f, 0.8f}, Vec3{-1, 0.5f, 0.5f}, Vec3{0.2f, -1, 0.1f}}) {
    directions.push_back(normalize(w));
    directions.push_back(mirrored_side(normalize(w)));
  }
  return directions;
}

SeenBsdf seen_from(const BsdfCase& c, Vec3 known) {
  const Shading shading = shade(*c.material, known);
  return {shading.bsdf, shading.frame.to_local(known)};
}

}  // namespace gradslc
