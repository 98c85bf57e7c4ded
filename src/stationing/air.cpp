// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/air.hpp"

#include <cmath>

namespace versine::stationing {

double group_refractivity(const Atmosphere& air, double wavelength) {
  const double w2 = 1.0 / (wavelength * wavelength);
  const double standard = 287.6155 + 4.88660 * w2 + 0.06800 * w2 * w2;  // at 0 deg C, 1013.25 hPa, dry, 375 ppm CO2
  const double kelvin = 273.15 + air.temperature;
  // Partial pressure of water vapour (Magnus, over water), hPa.
  const double vapour = air.humidity * 6.1078 * std::exp(17.2694 * air.temperature / (237.3 + air.temperature));
  return 273.15 / 1013.25 * standard * air.pressure / kelvin - 11.27 * vapour / kelvin;
}

double distance_factor(const Atmosphere& air, const Atmosphere& reference, double wavelength) {
  return (1.0 + 1e-6 * group_refractivity(reference, wavelength)) / (1.0 + 1e-6 * group_refractivity(air, wavelength));
}

}  // namespace versine::stationing
