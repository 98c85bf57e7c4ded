// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/stationing.hpp"
#include "versine/fusion/aided_ins.hpp"

namespace versine::app {

/// All stations and control points of a survey adjusted together with the survey's own trajectory.
struct ControlCheck {
  stationing::NetworkResult network;
  RunRecord record;  ///< control points that have moved, as warnings
};

/// Solves the recording once more with the stations' positions weakened by 5 cm, so that IMU, odometer and constraint
/// alone give the figure of the stations, and adjusts it together with all readings (stationing::adjust_network). With
/// the instrument beside the track there is no such figure: the readings are adjusted alone.
[[nodiscard]] Expected<ControlCheck> check_control(const StationingOutcome& stations,
                                                   const StationingProcessing& processing, fusion::AidedInsInput input,
                                                   fusion::AidedInsOptions options, Progress& progress, Log& log);

/// Positions of the instrument at the landmarks' times and their joint covariance, m-frame of `frame`; twelve stations
/// in a row each.
[[nodiscard]] std::vector<stationing::StationFigure> station_figures(
    const fusion::Solution& solution, const std::vector<sensors::LandmarkSample>& landmarks,
    const Eigen::Vector3d& lever_b, const geodesy::LocalFrame& frame);

}  // namespace versine::app
