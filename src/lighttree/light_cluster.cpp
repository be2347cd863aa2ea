#include "lighttree/light_cluster.h"

#include <algorithm>

#include "core/rgb.h"

namespace gradslc {
namespace {

/// Light leaves a VPL on the side of its shading normal with the geometric normal's |cos|. Where the two normals are at
/// an angle d, the geometric cosine is negative over the last d before the shading horizon, of size sin(d) at most: a
/// cone of half angle 2 d around the geometric normal bounds it there.
float leaf_cone_cosine(float cos_normals) {
  const float facing = std::max(cos_normals, 0.0f);
  return std::max(-1.0f, 2 * facing * facing - 1 - k_cone_rounding);
}

}  // namespace

void ConeUnion::add_axis(const Cone& cone) {
  sum_ = sum_ + cone.axis;
  whole_ |= cone.cosine <= -1;
}

void ConeUnion::close_axes() {
  const float squared = length_squared(sum_);
  whole_ |= !(squared > 1e-8f);
  if (!whole_) result_.axis = sum_ / std::sqrt(squared);
}

void ConeUnion::open_to(const Cone& cone) {
  if (whole_) return;
  const float cos_offset = std::min(dot(result_.axis, cone.axis), 1.0f);
  if (cos_offset + cone.cosine <= 0) {  // the two angles together reach pi
    whole_ = true;
    return;
  }
  const float sin_offset = std::sqrt(std::max(0.0f, 1 - cos_offset * cos_offset));
  result_.cosine = std::min(result_.cosine, cos_offset * cone.cosine - sin_offset * cone.sine());
}

Cone ConeUnion::result() const {
  if (whole_) return {{0, 0, 1}, -1};
  return {result_.axis, std::max(-1.0f, result_.cosine - k_cone_rounding)};
}

LightCluster make_cluster(const VplSet& set, const Vpl& vpl) {
  LightCluster cluster;
  cluster.box.extend(vpl.position);
  const float flux = luminance(vpl.flux);
  cluster.normals.axis = vpl.geometric_normal.decode();
  if (vpl.shading_normal != vpl.geometric_normal)
    cluster.normals.cosine = leaf_cone_cosine(dot(cluster.normals.axis, vpl.shading_normal.decode()));
  if (vpl.is_lambert()) {
    cluster.flux = flux;
    cluster.capped_flux = vpl.max_pi_f > 0 ? flux / vpl.max_pi_f : 0;
    return cluster;
  }
  const VplSurface& surface = set.surfaces[vpl.surface];
  cluster.flux = flux * surface.bound.broad;
  cluster.capped_flux = flux;
  if (surface.transmits) cluster.normals.cosine = -1;
  cluster.gloss = surface.bound.gloss.scaled(flux);
  cluster.mirrored = {mirrored(vpl.incoming.decode(), vpl.shading_normal.decode()), 1 - k_cone_rounding};
  return cluster;
}

}  // namespace gradslc
