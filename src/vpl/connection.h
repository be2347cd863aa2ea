#pragma once

#include "core/rgb.h"
#include "materials/lobes.h"
#include "materials/material.h"
#include "scene/surface.h"
#include "vpl/bounding.h"
#include "vpl/vpl.h"

namespace gradslc {

/// A surface point that gathers: its connectable lobes are lit by VPLs.
struct GatherPoint {
  const ShadedPoint& x;
  LobeSelection lobes;
};

/// The VPLs of a set with what their evaluation needs.
struct VplView {
  const std::vector<MaterialPtr>& materials;
  const VplSet& set;
  const Vpl& operator[](std::size_t index) const { return set.vpls[index]; }
};

/// f_c(y) of a VPL that is not Lambert, its textures looked up.
class GlossyVpl {
 public:
  GlossyVpl(const VplView& vpls, const Vpl& y);
  /// pi f_c(y) towards the unit direction `wo`, world space.
  Rgb pi_f(const Vec3& wo, const LobeSelection& lobes) const;

 private:
  Shading shading_;
  Vec3 incoming_;  // local
};

/// Light from a VPL to a gather point, without the test of visibility: radiance leaving x towards wo,
///   min(1, b/K) f_c(x) |cos_x| |cos_y| / d^2 f_c(y) flux,
/// and 0 where either lobe does not reach, or at distance 0.
Rgb unshadowed_contribution(const GatherPoint& point, const VplView& vpls, const Vpl& y, float bound);

/// The shadow ray of that connection: the segment from x to y, both ends off their surfaces. `normal`: y's geometric
/// one, for callers that have decoded it before.
Ray connection_segment(const GatherPoint& point, const Vpl& y, Normal3 normal);
inline Ray connection_segment(const GatherPoint& point, const Vpl& y) {
  return connection_segment(point, y, as_normal(y.geometric_normal.decode()));
}

}  // namespace gradslc
