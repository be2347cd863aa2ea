#pragma once

#include "scene/light.h"

namespace gradslc {

/// The same radiance from all directions, sampled uniformly.
class ConstantLight final : public Light {
 public:
  /// `radiance`: finite, >= 0.
  explicit ConstantLight(Rgb radiance) : radiance_(radiance) {}

  std::string_view kind() const override { return "constant"; }
  Rgb power(const BoundingSphere& scene) const override;
  std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const override;
  EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const override;
  bool is_environment() const override { return true; }
  Rgb radiance(Vec3 direction) const override;
  float pdf_direct(Vec3 direction) const override;

 private:
  Rgb radiance_;
};

}  // namespace gradslc
