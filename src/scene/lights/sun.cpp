#include "scene/lights/sun.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "scene/lights/spectrum_to_rgb.h"

namespace gradslc {
namespace {

/// A point of a curve that is linear between its points.
struct CurvePoint {
  double wavelength, value;
};

template <std::size_t size>
double interpolate(const CurvePoint (&curve)[size], double wavelength) {
  if (wavelength < curve[0].wavelength || wavelength > curve[size - 1].wavelength) return 0;
  std::size_t i = 1;
  while (curve[i].wavelength < wavelength) ++i;
  const CurvePoint &a = curve[i - 1], &b = curve[i];
  return a.value + (wavelength - a.wavelength) / (b.wavelength - a.wavelength) * (b.value - a.value);
}

// Preetham et al. 1999, table 2, from 380 nm on where the sun's spectrum begins. Absorption by mixed gases sets in
// beyond its end, 750 nm.
/// Outside the atmosphere, W/(m^2 nm sr).
constexpr CurvePoint k_solar[] = {
    {380, 16559.0}, {390, 16233.7}, {400, 21127.5}, {410, 25888.2}, {420, 25829.1}, {430, 24232.3}, {440, 26760.5},
    {450, 29658.3}, {460, 30545.4}, {470, 30057.5}, {480, 30663.7}, {490, 28830.4}, {500, 28712.1}, {510, 27825.0},
    {520, 27100.6}, {530, 27233.6}, {540, 26361.3}, {550, 25503.8}, {560, 25060.2}, {570, 25311.6}, {580, 25355.9},
    {590, 25134.2}, {600, 24631.5}, {610, 24173.2}, {620, 23685.3}, {630, 23212.1}, {640, 22827.7}, {650, 22339.8},
    {660, 21970.2}, {670, 21526.7}, {680, 21097.9}, {690, 20728.3}, {700, 20240.4}, {710, 19870.8}, {720, 19427.2},
    {730, 19072.4}, {740, 18628.9}, {750, 18259.2}};
/// Absorption by ozone, 1/cm.
constexpr CurvePoint k_ozone[] = {
    {355, 0},    {445, .003}, {450, .003}, {455, .004}, {460, .006}, {465, .008}, {470, .009}, {475, .012}, {480, .014},
    {485, .017}, {490, .021}, {495, .025}, {500, .03},  {505, .035}, {510, .04},  {515, .045}, {520, .048}, {525, .057},
    {530, .063}, {535, .07},  {540, .075}, {545, .08},  {550, .085}, {555, .095}, {560, .103}, {565, .11},  {570, .12},
    {575, .122}, {580, .12},  {585, .118}, {590, .115}, {595, .12},  {600, .125}, {605, .13},  {610, .12},  {620, .105},
    {630, .09},  {640, .079}, {650, .067}, {660, .057}, {670, .048}, {680, .036}, {690, .028}, {700, .023}, {710, .018},
    {720, .014}, {730, .011}, {740, .01},  {750, .009}};
/// Absorption by water vapour, 1/cm.
constexpr CurvePoint k_water[] = {{689, 0}, {690, .016}, {700, .024}, {710, .0125},
                                  {720, 1}, {730, .87},  {740, .061}, {750, .001}};

constexpr double k_ozone_thickness = 0.35;  // cm at normal temperature and pressure
constexpr double k_precipitable_water = 2;  // cm
constexpr double k_aerosol_exponent = 1.3;  // Angstrom's alpha

double degrees(double radians) { return radians * 180 / std::numbers::pi; }
double radians(double degrees) { return degrees * std::numbers::pi / 180; }

}  // namespace

Rgb sun_radiance(double zenith_angle, double turbidity) {
  const double optical_mass = 1 / (std::cos(zenith_angle) + 0.15 * std::pow(93.885 - degrees(zenith_angle), -1.253));
  const double aerosols = 0.04608365822050 * turbidity - 0.04586025928522;  // Angstrom's beta
  VisibleSpectrum arriving{};
  for (std::size_t i = 0; i < arriving.size(); ++i) {
    const double micrometres = wavelength(i) / 1000;
    const double rayleigh = 0.008735 * std::pow(micrometres, -4.08);
    const double aerosol = aerosols * std::pow(micrometres, -k_aerosol_exponent);
    const double ozone = interpolate(k_ozone, wavelength(i)) * k_ozone_thickness;
    const double water = interpolate(k_water, wavelength(i)) * k_precipitable_water;
    const double vapour = 0.2385 * water / std::pow(1 + 20.07 * water * optical_mass, 0.45);
    arriving[i] = interpolate(k_solar, wavelength(i)) * std::exp(-optical_mass * (rayleigh + aerosol + ozone + vapour));
  }
  return spectrum_to_rgb(arriving);
}

SunPosition sun_position(const SunTime& time) {
  using namespace std::chrono;
  const sys_days date = year(time.year) / time.month / time.day;
  const double hours = time.hour - time.timezone + (time.minute + time.second / 60) / 60;  // universal time
  const double days = static_cast<double>((date - sys_days(year(2000) / 1 / 1)).count()) - 0.5 + hours / 24;

  const double omega = 2.1429 - 0.0010394594 * days;
  const double mean_longitude = 4.8950630 + 0.017202791698 * days;
  const double anomaly = 6.2400600 + 0.0172019699 * days;
  const double longitude = mean_longitude + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) -
                           0.0001134 - 0.0000203 * std::sin(omega);
  const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);

  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  const double sidereal_hours = 6.6974243242 + 0.0657098283 * days + hours;  // in Greenwich
  const double hour_angle = radians(sidereal_hours * 15 + time.longitude) - right_ascension;
  const double latitude = radians(time.latitude);
  const double cosine =
      std::cos(latitude) * std::cos(hour_angle) * std::cos(declination) + std::sin(declination) * std::sin(latitude);
  const double zenith_angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  constexpr double parallax = 6371.01 / 149597890;  // the earth's radius over its distance
  return {zenith_angle + parallax * std::sin(zenith_angle),
          std::atan2(-std::sin(hour_angle),
                     std::tan(declination) * std::cos(latitude) - std::sin(latitude) * std::cos(hour_angle))};
}

}  // namespace gradslc
