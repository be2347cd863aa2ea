#pragma once

#include "core/image.h"
#include "core/vec.h"
#include "scene/lights/sun.h"

namespace gradslc {

/// What Mitsuba 0.6 needs to know of a clear sky.
struct ClearSky {
  SunPosition sun;         ///< above the horizon
  double turbidity = 3;    ///< in [1,10]
  Rgb albedo = Rgb(0.2f);  ///< of the ground, in [0,1]
  double stretch = 1;      ///< in [1,2]: angles from the zenith are this many times larger
  bool extend = false;     ///< the horizon's colour goes on below it and fades out to the nadir
};

/// A black latitude-longitude map, `width` by half of it. The map's top is the zenith; columns as EnvironmentMap has
/// them.
RgbImage black_map(int width);

/// Adds the sky's radiance at the texels' centres (Hosek and Wilkie 2012), times `scale`.
void add_sky(RgbImage& map, const ClearSky& sky, float scale);

/// Adds the sun as a disk of `radius_scale` > 0 times its size and the same power, times `scale`: each texel gets the
/// disk's radiance times the part of it, in angles, that the disk covers.
void add_sun(RgbImage& map, const ClearSky& sky, float scale, double radius_scale);

/// Irradiance that the sun gives to a plane across its light, W/(m^2 nm).
Rgb sun_irradiance(const ClearSky& sky);

/// Direction of the sun in the map's space, unit.
Vec3 sun_direction(const ClearSky& sky);

}  // namespace gradslc
