#pragma once

#include <cmath>

#include "core/rgb.h"

namespace gradslc {

/// Fresnel reflectance of an interface with a conductor, unpolarised, exact: `eta`, `k` relative to the outside.
/// `cos_theta` in [0,1] (Born and Wolf 1999, section 14.2).
float fresnel_conductor(float cos_theta, float eta, float k);
/// The same per channel.
Rgb fresnel_conductor(float cos_theta, Rgb eta, Rgb k);

/// What a smooth interface between dielectrics does with light.
struct DielectricFresnel {
  float reflectance = 1;      ///< unpolarised, in [0,1]; the rest is refracted
  float cos_transmitted = 0;  ///< of the refracted direction, on the other side than cos_theta; 0: total reflection
};

/// Exact, for any angle (Born and Wolf 1999, section 1.5.2). `eta` > 0: index inside over index outside; cos_theta in
/// [-1,1] is positive outside.
inline DielectricFresnel fresnel_dielectric(float cos_theta, float eta) {
  const float ratio = cos_theta > 0 ? eta : 1 / eta;  // index behind the interface over index before it
  const float cos_i = std::abs(cos_theta);
  const float sin2_t = (1 - cos_i * cos_i) / (ratio * ratio);
  if (sin2_t >= 1) return {};
  const float cos_t = std::sqrt(1 - sin2_t);
  const float perpendicular = (cos_i - ratio * cos_t) / (cos_i + ratio * cos_t);
  const float parallel = (ratio * cos_i - cos_t) / (ratio * cos_i + cos_t);
  return {0.5f * (perpendicular * perpendicular + parallel * parallel), cos_theta > 0 ? -cos_t : cos_t};
}

/// Reflectance for diffuse light from outside: the integral of 2 F(cos) cos over cos in [0,1], to 1e-6. `eta` > 0 as
/// above; the inverse of eta gives the reflectance for light from inside.
float diffuse_fresnel_reflectance(float eta);

}  // namespace gradslc
