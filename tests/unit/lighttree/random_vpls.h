#pragma once
// Random VPLs and gather points of all kinds of materials.

#include <cmath>

#include "lighttree/bounds.h"
#include "materials/plugins.h"
#include "support/random.h"

namespace gradslc {

inline const std::vector<MaterialPtr>& materials() {
  static const std::vector<MaterialPtr> k_materials = {
      make_diffuse(Texture(Rgb(0.8f, 0.5f, 0.2f))),
      make_rough_mirror(MicrofacetType::ggx, 0.3f, Texture(Rgb(0.9f, 0.6f, 0.3f))),
      make_rough_plastic(MicrofacetType::beckmann, 0.15f, 1.5f, Texture(Rgb(0.2f, 0.4f, 0.6f)), true),
      make_rough_dielectric(MicrofacetType::ggx, 0.4f, 1.5f)};
  return k_materials;
}

/// What a random material is at a random point: smooth normals may differ from the geometric one by some 50 degrees.
inline ShadedPoint random_point(TestRandom& random, Point3 position, std::uint32_t material) {
  ShadedPoint x;
  x.point.position = position;
  x.point.material = material;
  x.point.geometric_normal = as_normal(random.direction());
  x.point.shading_normal = as_normal(
      normalize(as_vec(x.point.geometric_normal) + (random.below(2) == 0 ? 0.0f : 0.8f) * random.direction()));
  Shading shading{frame_from_normal(x.point.shading_normal), {}};
  Vec3 known;
  do known = random.direction();
  while (std::abs(dot(known, x.point.shading_normal)) < 1e-3f);
  if (material < 3 && dot(known, x.point.shading_normal) < 0) known = -known;  // reflects only
  materials()[material]->shade({}, known, shading);
  x.frame = shading.frame, x.bsdf = shading.bsdf;
  x.wo = x.to_local(known);
  return x;
}

inline Point3 random_position(TestRandom& random, float spread) {
  return Point3{} + spread * random.get1() * random.direction();
}

/// Lambertian VPLs; with `glossy`, of all materials.
inline VplSet random_vpls(TestRandom& random, std::size_t count, float spread = 1, bool glossy = false) {
  VplSet set;
  for (std::size_t i = 0; i < count; ++i) {
    const auto material = static_cast<std::uint32_t>(glossy ? random.below(materials().size()) : 0);
    const ShadedPoint y = random_point(random, random_position(random, spread), material);
    Vpl vpl;
    vpl.position = y.point.position;
    vpl.flux = Rgb(random.get1(), random.get1(), random.get1());
    vpl.geometric_normal = OctahedralNormal(as_vec(face_forward(y.point.geometric_normal, as_vec(y.frame.n))));
    vpl.shading_normal = OctahedralNormal(as_vec(y.frame.n));
    vpl.incoming = OctahedralNormal(y.to_world(y.wo));
    vpl.vertex = 1;
    if (material == 0) {
      vpl.max_pi_f = 0.01f + 0.99f * random.get1();
      vpl.flux *= vpl.max_pi_f;
    } else {
      const ValueBound bound = y.bsdf.connectable_value_bound(y.wo, LobeSelection());
      vpl.max_pi_f = bound.max();
      vpl.surface = static_cast<std::uint32_t>(set.surfaces.size());
      set.surfaces.push_back({.material = material,
                              .uv = {},
                              .tangent = OctahedralNormal(y.frame.s),
                              .bound = bound,
                              .behind = y.wo.z < 0,
                              .transmits = y.bsdf.transmits(LobeSelection().only_connectable())});
    }
    set.vpls.push_back(vpl);
  }
  return set;
}

inline ShadedPoint random_gather_point(TestRandom& random, float spread, bool glossy = false) {
  const auto material = static_cast<std::uint32_t>(glossy ? random.below(materials().size()) : 0);
  return random_point(random, random_position(random, spread), material);
}

inline Rgb unshadowed(const ShadedPoint& x, const LightTree& tree, std::size_t vpl, float bound) {
  return unshadowed_contribution({x, LobeSelection()}, {materials(), tree.set}, tree.set.vpls[vpl], bound);
}

}  // namespace gradslc
