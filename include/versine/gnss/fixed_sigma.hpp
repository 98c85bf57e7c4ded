// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/sensors/measurements.hpp"

namespace versine::gnss {

/// RTKLIB's variance of a fixed position is a small difference of large numbers (its prior of 30 m squared against what
/// the phases leave of it): it scatters from epoch to epoch and can come out as nothing. Each component of a fixed
/// epoch is raised to the median of the fixed epochs around it (`half` to either side); others stay.
[[nodiscard]] Series<sensors::GnssSample> with_steady_sigmas(Series<sensors::GnssSample> series, std::size_t half = 30);

}  // namespace versine::gnss
