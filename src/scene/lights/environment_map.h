#pragma once

#include <vector>

#include "core/distribution.h"
#include "core/image.h"
#include "scene/light.h"
#include "scene/lights/orientation.h"

namespace gradslc {

/// Radiance from infinity by a latitude-longitude map: u = atan2(x, -z) / 2 pi and v = acos(y) / pi in the light's own
/// space, v = 0 at the top row's upper edge; bilinear between texel centres, wrapping in u and clamped in v.
/// Directions are sampled with a density proportional to the luminance, exactly: pdf = luminance / its integral.
class EnvironmentMap final : public Light {
 public:
  /// `radiance`: at least one texel, all finite and >= 0. `kind`: name of the plug-in, must outlive this.
  EnvironmentMap(RgbImage radiance, const Orientation& orientation, std::string_view kind = "envmap");

  std::string_view kind() const override { return kind_; }
  Rgb power(const BoundingSphere& scene) const override;
  std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const override;
  EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const override;
  bool is_environment() const override { return true; }
  Rgb radiance(Vec3 direction) const override;
  float pdf_direct(Vec3 direction) const override;
  std::size_t memory_bytes() const override;

  const RgbImage& map() const { return map_; }
  /// Integral of the radiance over the sphere: W/m^2 on the bounding disk.
  Rgb integral() const { return integral_; }

 private:
  // The sphere is cut along the texels' centres. Band b lies between the centres of rows b-1 and b (half a row high at
  // the poles, where the map is clamped); its cell c between the centres of columns c and c+1.
  struct Band {
    int upper, lower;  // rows of texels
    double theta, height;
    double upper_weight, lower_weight;  // integrals of 1-t and t times sin(theta) dtheta, t in [0,1] down the band
  };
  Band band(int index) const;
  double texel_luminance(int column, int row) const;
  std::vector<double> cell_weights(const Band& band) const;
  Vec3 sample_direction(Vec2 u) const;
  float pdf_of(Rgb radiance) const;

  RgbImage map_;
  Orientation orientation_;
  std::string_view kind_;
  DiscreteDistribution bands_;               // by integral of luminance
  std::vector<DiscreteDistribution> cells_;  // of each band
  Rgb integral_;
  double luminance_integral_ = 0;
};

}  // namespace gradslc
