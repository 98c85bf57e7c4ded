// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/core/error.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/track/compute.hpp"

namespace versine::track {

/// Attitude of the trolley by mileage, as its present mounting angles tell it.
struct AttitudeLine {
  double step = 0.25;
  double direction = 1.0;           ///< +1: the x axis points along increasing mileage
  std::vector<double> mileage;      ///< m
  std::vector<double> roll, pitch;  ///< rad, of the trolley's own axes
  /// Heading of the x axis minus the azimuth of the design axis or, without design, of the trolley's own path, rad.
  std::vector<double> heading_error;
};
[[nodiscard]] Expected<AttitudeLine> attitude_line(const GeometryInput& input, const GeometryOptions& options,
                                                   Progress& progress);

/// Mounting angles from passes in both orientations (Chen 2018 section 3.2): turned round on the same track, the
/// track's roll and pitch change sign and the mounting's stay; heading from the azimuth.
struct MountingCalibration {
  geodesy::Euler correction;  ///< found: what the present mounting lacks, rad
  geodesy::Euler sigma;       ///< of it, from the scatter over independent stretches, rad
  geodesy::Euler mounting;    ///< new value for Trolley::mounting
  std::size_t points = 0;     ///< mileages common to both orientations
  double length = 0.0;        ///< m
};
/// `passes` of one trolley over common track, at least one in each orientation. `settle`: length over which scatter is
/// taken as correlated, m. Fails when there is no orientation's counterpart or no common mileage.
[[nodiscard]] Expected<MountingCalibration> calibrate_mounting(const std::vector<AttitudeLine>& passes,
                                                               const geodesy::Euler& present, double settle = 10.0);

}  // namespace versine::track
