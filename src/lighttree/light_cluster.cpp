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
