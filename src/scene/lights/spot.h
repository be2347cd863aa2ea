#pragma once

#include "core/frame.h"
#include "scene/light.h"

namespace gradslc {

/// A point source whose intensity is full within `beam_width` of the axis and falls linearly with the angle to zero at
/// `cutoff_angle` (Mitsuba's spot).
class SpotLight final : public Light {
 public:
  /// `axis`: unit. `intensity`: W/sr on the axis, finite, >= 0. Angles from the axis in radians,
  /// 0 <= beam_width <= cutoff_angle <= pi, cutoff_angle > 0.
  SpotLight(Point3 position, Vec3 axis, Rgb intensity, float cutoff_angle, float beam_width);

  std::string_view kind() const override { return "spot"; }
  Rgb power(const BoundingSphere& scene) const override;
  std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const override;
  EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const override;

 private:
  float falloff(float cos_theta) const;

  Point3 position_;
  Frame frame_;  // normal along the axis
  Rgb intensity_;
  float cutoff_angle_, beam_width_;
  float cos_cutoff_, cos_beam_;
};

}  // namespace gradslc
