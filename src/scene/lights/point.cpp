#include "scene/lights/point.h"

#include "core/warp.h"

namespace gradslc {

std::optional<DirectSample> direct_from_point(Point3 source, Rgb intensity, Point3 reference) {
  const Vec3 to_source = source - reference;
  const float squared = length_squared(to_source);
  const Rgb arriving = squared > 0 ? intensity / squared : Rgb();
  if (is_black(arriving) || !is_finite(arriving)) return std::nullopt;
  return DirectSample{.wi = to_source / std::sqrt(squared),
                      .radiance = arriving,
                      .pdf_solid_angle = 1,
                      .position = source,
                      .delta = true};
}

Rgb PointLight::power(const BoundingSphere& /*scene*/) const { return 4 * k_pi * intensity_; }

std::optional<DirectSample> PointLight::sample_direct(Point3 reference, Vec2 /*u*/) const {
  return direct_from_point(position_, intensity_, reference);
}

EmissionSample PointLight::sample_emission(Vec2 /*u_point*/, Vec2 u_direction, const EmissionExtent& /*extent*/) const {
  return {Ray{position_, square_to_sphere(u_direction)}, 4 * k_pi * intensity_, true};
}

}  // namespace gradslc
