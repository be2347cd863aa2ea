#include "scene/lights/constant.h"

#include "core/warp.h"
#include "scene/lights/bounding_disk.h"

namespace gradslc {
namespace {

constexpr float k_sphere = 4 * k_pi;  // sr

}  // namespace

Rgb ConstantLight::power(const BoundingSphere& scene) const { return k_sphere * disk_area(scene) * radiance_; }

std::optional<DirectSample> ConstantLight::sample_direct(Point3 /*reference*/, Vec2 u) const {
  return DirectSample{.wi = square_to_sphere(u),
                      .radiance = radiance_,
                      .pdf_solid_angle = 1 / k_sphere,
                      .position = {},
                      .infinite = true};
}

EmissionSample ConstantLight::sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const {
  return emit_through_disk(square_to_sphere(u_direction), k_sphere * radiance_, u_point, extent);
}

Rgb ConstantLight::radiance(Vec3 /*direction*/) const { return radiance_; }

float ConstantLight::pdf_direct(Vec3 /*direction*/) const { return is_black(radiance_) ? 0 : 1 / k_sphere; }

}  // namespace gradslc
