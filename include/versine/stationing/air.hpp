// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/stationing/readings.hpp"

namespace versine::stationing {

/// Group refractivity of air for electronic distance measurement, (n - 1) * 1e6: closed formulae of IAG resolution 3
/// of 1999 (IUGG, Birmingham), for 0.65 to 0.85 um within 0.25 from -40 to 50 deg C.
/// `wavelength`: of the carrier, um.
[[nodiscard]] double group_refractivity(const Atmosphere& air, double wavelength);

/// First velocity correction: what to multiply a distance with that the instrument computed for its `reference` air.
[[nodiscard]] double distance_factor(const Atmosphere& air, const Atmosphere& reference, double wavelength);

}  // namespace versine::stationing
