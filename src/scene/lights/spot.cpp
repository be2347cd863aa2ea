#include "scene/lights/spot.h"

#include "core/constants.h"
#include "scene/lights/point.h"

namespace gradslc {
namespace {

/// Of the cone around +z; uniform over its 2 pi (1 - cos_cutoff) steradians.
Vec3 square_to_cone(Vec2 u, float cos_cutoff) {
  const float z = 1 - u.x * (1 - cos_cutoff);
  const float radius = std::sqrt(std::max(0.0f, 1 - z * z));
  return {radius * std::cos(2 * k_pi * u.y), radius * std::sin(2 * k_pi * u.y), z};
}

}  // namespace

SpotLight::SpotLight(Point3 position, Vec3 axis, Rgb intensity, float cutoff_angle, float beam_width)
    : position_(position),
      frame_(frame_from_normal(as_normal(axis))),
      intensity_(intensity),
      cutoff_angle_(cutoff_angle),
      beam_width_(beam_width),
      cos_cutoff_(std::cos(cutoff_angle)),
      cos_beam_(std::cos(beam_width)) {}

float SpotLight::falloff(float cos_theta) const {
  if (cos_theta >= cos_beam_) return 1;
  if (cos_theta <= cos_cutoff_) return 0;
  return (cutoff_angle_ - std::acos(cos_theta)) / (cutoff_angle_ - beam_width_);
}

/// 2 pi times the integral of falloff sin(theta): 1 - cos b up to the beam's width b, and from there to the cutoff c
/// ((c - b) cos b - sin c + sin b) / (c - b).
Rgb SpotLight::power(const BoundingSphere& /*scene*/) const {
  const double c = cutoff_angle_, b = beam_width_;
  const double integral = c > b ? 1 - (std::sin(c) - std::sin(b)) / (c - b) : 1 - std::cos(c);
  return static_cast<float>(2 * std::numbers::pi * integral) * intensity_;
}

std::optional<DirectSample> SpotLight::sample_direct(Point3 reference, Vec2 /*u*/) const {
  const Vec3 from_source = reference - position_;
  const float squared = length_squared(from_source);
  if (!(squared > 0)) return std::nullopt;
  return direct_from_point(position_, falloff(dot(frame_.n, from_source) / std::sqrt(squared)) * intensity_, reference);
}

EmissionSample SpotLight::sample_emission(Vec2 /*u_point*/, Vec2 u_direction, const EmissionExtent& /*extent*/) const {
  const Vec3 local = square_to_cone(u_direction, cos_cutoff_);
  const float cone = 2 * k_pi * (1 - cos_cutoff_);
  return {Ray{position_, frame_.to_world(local)}, cone * falloff(local.z) * intensity_, true};
}

}  // namespace gradslc
