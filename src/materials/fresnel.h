#pragma once

#include "core/rgb.h"

namespace gradslc {

/// Fresnel reflectance of an interface with a conductor, unpolarised, exact: `eta`, `k` relative to the outside.
/// `cos_theta` in [0,1] (Born and Wolf 1999, section 14.2).
float fresnel_conductor(float cos_theta, float eta, float k);
/// The same per channel.
Rgb fresnel_conductor(float cos_theta, Rgb eta, Rgb k);

}  // namespace gradslc
