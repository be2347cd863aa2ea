#include "lighttree/light_tree.h"

#include <algorithm>

#include "core/rgb.h"

namespace gradslc {
namespace {

struct Cone {
  Vec3 axis;
  float cosine;
};

/// A cone that holds two others: theirs where one holds the other, else the mean axis opened to the wider of both.
/// Half angles add by cosines and sines; what exceeds pi is the whole sphere.
Cone merge_cones(Cone a, Cone b) {
  constexpr Cone k_sphere{{0, 0, 1}, -1};
  if (a.cosine <= -1 || b.cosine <= -1) return k_sphere;
  const Vec3 sum = a.axis + b.axis;
  const float squared = length_squared(sum);
  if (!(squared > 1e-8f)) return k_sphere;
  const Vec3 axis = sum / std::sqrt(squared);
  float cosine = 1;
  for (const Cone& cone : {a, b}) {
    const float cos_offset = std::min(dot(axis, cone.axis), 1.0f);
    const float sin_offset = std::sqrt(std::max(0.0f, 1 - cos_offset * cos_offset));
    const float sin_half = std::sqrt(std::max(0.0f, 1 - cone.cosine * cone.cosine));
    if (cos_offset + cone.cosine <= 0) return k_sphere;  // the two angles together reach pi
    cosine = std::min(cosine, cos_offset * cone.cosine - sin_offset * sin_half);
  }
  constexpr float k_rounding = 4e-7f;  // a few ulp of 1: the cone must still hold its normals after rounding
  return {axis, std::max(-1.0f, cosine - k_rounding)};
}

/// Light leaves a VPL on the side of its shading normal with the geometric normal's |cos|. Where the two normals are at
/// an angle d, the geometric cosine is negative over the last d before the shading horizon, of size sin(d) at most: a
/// cone of half angle 2 d around the geometric normal bounds it there.
float leaf_cone_cosine(float cos_normals) {
  constexpr float k_rounding = 4e-7f;  // a few ulp of 1
  return cos_normals > 0 ? std::max(-1.0f, 2 * cos_normals * cos_normals - 1 - k_rounding) : -1;
}

}  // namespace

LightNode make_leaf(const VplSet& set, std::uint32_t vpl_index) {
  const Vpl& vpl = set.vpls[vpl_index];
  LightNode node;
  node.box.extend(vpl.position);
  const float flux = luminance(vpl.flux);
  node.flux = vpl.is_lambert() ? flux : flux * vpl.max_pi_f;
  node.capped_flux = !vpl.is_lambert() ? flux : vpl.max_pi_f > 0 ? flux / vpl.max_pi_f : 0;
  node.cone_axis = vpl.geometric_normal.decode();
  if (set.transmits(vpl))
    node.cone_cos = -1;
  else if (vpl.shading_normal != vpl.geometric_normal)
    node.cone_cos = leaf_cone_cosine(dot(node.cone_axis, vpl.shading_normal.decode()));
  node.left = vpl_index;
  return node;
}

LightNode merge_nodes(const LightNode& a, const LightNode& b, NodeIndex left, NodeIndex right) {
  LightNode node;
  node.box = a.box;
  node.box.extend(b.box);
  node.flux = a.flux + b.flux;
  node.capped_flux = a.capped_flux + b.capped_flux;
  const Cone cone = merge_cones({a.cone_axis, a.cone_cos}, {b.cone_axis, b.cone_cos});
  node.cone_axis = cone.axis, node.cone_cos = cone.cosine;
  node.left = left, node.right = right;
  return node;
}

}  // namespace gradslc
