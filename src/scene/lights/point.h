#pragma once

#include "scene/light.h"

namespace gradslc {

/// The same radiant intensity in all directions from one point.
class PointLight final : public Light {
 public:
  /// `intensity`: W/sr, finite, >= 0.
  PointLight(Point3 position, Rgb intensity) : position_(position), intensity_(intensity) {}

  std::string_view kind() const override { return "point"; }
  Rgb power(const BoundingSphere& scene) const override;
  std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const override;
  EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const override;

 private:
  Point3 position_;
  Rgb intensity_;
};

/// What a point source of that intensity towards the reference gives there: intensity / distance^2, as a delta sample;
/// nullopt where that is zero or not finite (the reference is the source).
std::optional<DirectSample> direct_from_point(Point3 source, Rgb intensity, Point3 reference);

}  // namespace gradslc
