#pragma once

#include <numbers>

#include "core/rgb.h"

namespace gradslc {

/// Half the angle under which the sun appears, radians (its diameter 0.5358 degrees, as Mitsuba 0.6 has it).
constexpr double k_sun_radius = 0.5358 / 2 * std::numbers::pi / 180;

/// Mean radiance of the sun's disk through a clear atmosphere (Preetham, Shirley and Smits 1999, "A Practical Analytic
/// Model for Daylight", appendix A.1): solar spectrum times the transmittances of Rayleigh scattering, aerosols, ozone
/// and water vapour. `zenith_angle` in [0, pi/2], radians; `turbidity` >= 1. W/(m^2 sr nm), weighted as the sky is.
Rgb sun_radiance(double zenith_angle, double turbidity);

/// Angle from the zenith and, from -z over +x, around it; radians.
struct SunPosition {
  double zenith_angle, azimuth;
};

/// A local time and a place on the earth.
struct SunTime {
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;
  double latitude = 35.6894, longitude = 139.6917;  ///< degrees, north and east positive
  double timezone = 9;                              ///< hours ahead of universal time
};

/// Where the sun stands, azimuth from the north over the east (Blanco-Muriel, Alarcon-Padilla, Lopez-Moratalla and
/// Lara-Coira 2001, "Computing the solar vector"; to half a minute of arc from 1999 to 2015). The date must exist.
SunPosition sun_position(const SunTime& time);

}  // namespace gradslc
