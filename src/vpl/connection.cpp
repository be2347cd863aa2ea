#include "vpl/connection.h"

namespace gradslc {

GlossyVpl::GlossyVpl(const VplView& vpls, const Vpl& y) {
  const VplSurface& surface = vpls.set.surfaces[y.surface];
  const float side = surface.behind ? -1.0f : 1.0f;
  vpls.materials[surface.material]->shade({surface.uv, Vec3(), Vec3()}, {0, 0, side}, shading_);
  shading_.frame = frame_from_normal_and_tangent(as_normal(y.shading_normal.decode()), surface.tangent.decode());
  incoming_ = shading_.frame.to_local(y.incoming.decode());
}

Rgb GlossyVpl::pi_f(const Vec3& wo, const LobeSelection& lobes) const {
  return k_pi * shading_.bsdf.eval(shading_.frame.to_local(wo), incoming_, lobes.only_connectable());
}

Rgb unshadowed_contribution(const GatherPoint& point, const VplView& vpls, const Vpl& y, float bound) {
  const ShadedPoint& x = point.x;
  const Vec3 d = y.position - x.point.position;
  const float distance2 = length_squared(d);
  if (!(distance2 > 0)) return Rgb();
  const Vec3 wi = d / std::sqrt(distance2);
  if (y.is_lambert() && dot(y.shading_normal.decode(), wi) >= 0) return Rgb();
  const Vec3 wi_local = x.to_local(wi);
  const Rgb f_x = x.bsdf.eval(x.wo, wi_local, point.lobes.only_connectable());
  if (is_black(f_x)) return Rgb();
  Rgb reflected = y.flux;
  float pi_f_y = y.max_pi_f;
  if (!y.is_lambert()) {
    const Rgb pi_f = GlossyVpl(vpls, y).pi_f(-wi, point.lobes);
    reflected *= pi_f;
    pi_f_y = max_channel(pi_f);
    if (pi_f_y == 0) return Rgb();
  }
  const float cos_y = dot(y.geometric_normal.decode(), wi);
  const float strength = connection_strength(k_pi * max_channel(f_x), pi_f_y, wi_local.z, cos_y, distance2);
  const float geometry = std::abs(wi_local.z * cos_y) / distance2;
  return f_x * reflected * (k_inv_pi * geometry * bounded_weight(strength, bound));
}

Ray connection_segment(const GatherPoint& point, const Vpl& y, Normal3 normal) {
  const Vec3 d = y.position - point.x.point.position;
  const Point3 from = offset_position(point.x.point, d);
  const Point3 to = offset_position(y.position, normal, y.error(), -d);
  return segment(from, to);
}

}  // namespace gradslc
