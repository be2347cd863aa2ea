#pragma once

#include "core/rgb.h"
#include "materials/bsdf.h"
#include "scene/surface.h"
#include "vpl/bounding.h"
#include "vpl/vpl.h"

namespace gradslc {

/// A surface point that gathers: its connectable lobe is lit by VPLs.
struct GatherPoint {
  SurfacePoint point;
  Bsdf bsdf;
  Vec3 wo;  ///< local, towards the camera
  LobeSelection lobes;
};

/// Light from a VPL to a gather point, without the test of visibility: radiance leaving x towards wo,
///   min(1, b/K) f_c(x) |cos_x| |cos_y| / d^2 f_c(y) flux,
/// and 0 where either lobe does not reach, or at distance 0.
inline Rgb unshadowed_contribution(const GatherPoint& x, const Vpl& y, float bound) {
  const Vec3 d = y.position - x.point.position;
  const float distance2 = length_squared(d);
  if (!(distance2 > 0)) return Rgb();
  const Vec3 wi = d / std::sqrt(distance2);
  if (dot(y.shading_normal.decode(), wi) >= 0) return Rgb();
  const Vec3 wi_local = x.point.shading.to_local(wi);
  const Rgb f_x = x.bsdf.eval(x.wo, wi_local, x.lobes.only_connectable());
  if (is_black(f_x)) return Rgb();
  const float cos_y = dot(y.geometric_normal.decode(), wi);
  const float strength = connection_strength(k_pi * max_channel(f_x), y.max_albedo, wi_local.z, cos_y, distance2);
  const float geometry = std::abs(wi_local.z * cos_y) / distance2;
  return f_x * y.reflected_flux * (k_inv_pi * geometry * bounded_weight(strength, bound));
}

/// The shadow ray of that connection: the segment from x to y, both ends off their surfaces.
inline Ray connection_segment(const GatherPoint& x, const Vpl& y) {
  const Vec3 d = y.position - x.point.position;
  const Point3 from = offset_position(x.point, d);
  const Point3 to = offset_position(y.position, as_normal(y.geometric_normal.decode()), y.error, -d);
  return segment(from, to);
}

}  // namespace gradslc
