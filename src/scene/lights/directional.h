#pragma once

#include "scene/light.h"

namespace gradslc {

/// Parallel light from infinity.
class DirectionalLight final : public Light {
 public:
  /// `direction`: unit, in which the light travels. `irradiance`: W/m^2 of a surface perpendicular to it, finite, >= 0.
  DirectionalLight(Vec3 direction, Rgb irradiance) : direction_(direction), irradiance_(irradiance) {}

  std::string_view kind() const override { return "directional"; }
  Rgb power(const BoundingSphere& scene) const override;
  std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const override;
  EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const override;

 private:
  Vec3 direction_;
  Rgb irradiance_;
};

}  // namespace gradslc
