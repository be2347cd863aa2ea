#pragma once

#include <array>

#include "core/rgb.h"

namespace gradslc {

/// Radiance of the clear sky (Hosek and Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance").
class HosekWilkieSky {
 public:
  /// `turbidity` in [1,10]; `ground_albedo` in [0,1]; `sun_elevation` above the horizon, radians in [0, pi/2].
  HosekWilkieSky(double turbidity, Rgb ground_albedo, double sun_elevation);

  /// At the angle `theta` < pi/2 from the zenith and `gamma` from the sun, radians. W/(m^2 sr nm), the mean over
  /// wavelengths as the eye weights them (Y of an equal-energy spectrum is its value); >= 0.
  Rgb radiance(double theta, double gamma) const;

 private:
  struct Channel {
    std::array<double, 9> shape{};
    double level = 0;
  };
  static double radiance(const Channel& channel, double theta, double gamma);

  std::array<Channel, 3> channels_;
};

}  // namespace gradslc
