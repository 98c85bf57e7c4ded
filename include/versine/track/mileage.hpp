// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "versine/track/compute.hpp"

namespace versine::track {

/// Epochs of the trajectory that geometry uses, in order of increasing mileage, with the mileage of the trolley's
/// beam. Standing still and rolling back leave epochs out, so mileage increases strictly.
struct RunMileage {
  std::vector<std::uint32_t> epoch;  ///< index into the trajectory
  std::vector<double> mileage;       ///< continuous, m
  std::vector<float> offset;         ///< of the trolley's middle from the design axis, m, right; NaN without design
  double direction = 1.0;            ///< +1: the trolley's x axis points along increasing mileage
  std::vector<std::pair<double, double>> repeated;  ///< mileages passed more than once, m
  RunRecord record;
};

/// Mileage by projection onto the design axis (map metres along it), else by the way of the trajectory along its own
/// axis, or of the odometers, laid between known marks (Chen 2018 section 4.4). `spacing`: epochs closer than that to
/// the last one used are left out.
[[nodiscard]] Expected<RunMileage> synchronise_mileage(const GeometryInput& input, const GeometryOptions& options,
                                                       const geodesy::ProjectMap& projection, double spacing);

/// Middle of the track under the trolley's beam, v-frame, for the nominal gauge.
[[nodiscard]] Eigen::Vector3d beam_centre(const Trolley& trolley, double nominal_gauge);

}  // namespace versine::track
