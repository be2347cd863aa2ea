#include "scene/lights/directional.h"

#include "scene/lights/bounding_disk.h"

namespace gradslc {

Rgb DirectionalLight::power(const BoundingSphere& scene) const { return disk_area(scene) * irradiance_; }

std::optional<DirectSample> DirectionalLight::sample_direct(Point3 /*reference*/, Vec2 /*u*/) const {
  return DirectSample{.wi = -direction_,
                      .radiance = irradiance_,
                      .pdf_solid_angle = 1,
                      .position = {},
                      .infinite = true,
                      .delta = true};
}

EmissionSample DirectionalLight::sample_emission(Vec2 u_point, Vec2 /*u_direction*/,
                                                 const EmissionExtent& extent) const {
  EmissionSample sample = emit_through_disk(-direction_, irradiance_, u_point, extent);
  sample.delta = true;
  return sample;
}

}  // namespace gradslc
