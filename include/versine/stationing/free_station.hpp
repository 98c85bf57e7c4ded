// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/stationing/control_network.hpp"
#include "versine/stationing/reduction.hpp"
#include "versine/stationing/result.hpp"

namespace versine::stationing {

/// The plumb line as another sensor tells it.
struct Plumb {
  Eigen::Vector3d up_s = -Eigen::Vector3d::UnitZ();  ///< up in the instrument's axes, length 1
  double sigma = 0.0;                                ///< rad, each axis
};

struct FreeStationOptions {
  bool solve_scale = false;          ///< the scale of the distances is an unknown too
  std::optional<double> tilt_sigma;  ///< the instrument is levelled this well, rad; none: it lies as the trolley lies
  double significance = 0.001;       ///< of the test of one target: this share of good targets is lost
  double power = 0.8;                ///< of the minimum detectable blunder
  double tolerance = 0.05;           ///< to recognise a point by its coordinates, m
  double largest_tilt = 0.35;        ///< of the standing axis against the plumb line, rad
  double wanted_sigma = 1e-3;        ///< of the position, each axis; a worse geometry is called poor, m
  bool identify = true;              ///< targets without or with unknown numbers are found by their coordinates
  /// Indices of targets that contradict the rest, decided elsewhere: these are left out and no other is.
  std::optional<std::vector<std::size_t>> left_out;
  std::optional<Plumb> plumb;           ///< observed beside the targets
  std::optional<Eigen::Vector3d> near;  ///< roughly where the station is, m-frame; needed when no number is known and
                                        ///< the network repeats itself
};

/// Free stationing (resection with full attitude): position and attitude of the instrument from three or more targets
/// on control points. Stages: numbers to points; start value by consensus; least squares with a robust loss; least
/// squares with the sigmas of instrument and control points; data snooping (Baarda 1968; for whole targets, Teunissen
/// 2006 "Testing theory" ch. 4), one target at a time, the worst first, and re-admission of what fits in the end.
///
/// The control points' covariance is propagated into the observations, which for one station equals taking the
/// coordinates as observations.
///
/// Fails when fewer than three targets are usable, when they lie on a line, when no three of them agree, and when the
/// readings show a systematic fault (angles in another unit, a prism constant applied twice, easting and northing
/// exchanged); the error tells which, with the cure.
[[nodiscard]] Expected<StationResult> free_station(const ReducedStation& station, const ControlNetwork& network,
                                                   const Instrument& instrument, const FreeStationOptions& options);

/// A control point that several stations see away from its coordinates in the same direction.
struct MovedPoint {
  std::string name;
  std::vector<std::string> stations;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< mean of the stations, m-frame, m
};

/// A station that could not be computed.
struct FailedStation {
  std::string name;
  std::optional<Time> from, to;
  Error error;
};

struct StationingRun {
  std::vector<StationResult> stations;
  std::vector<FailedStation> failed;
  std::vector<MovedPoint> moved;
};

/// All stationings of a survey: each by itself first, then what contradicts is looked for in all of them together
/// (neighbouring stations see the same control points, so that a wrong sighting and a moved point can be told apart,
/// and two targets against two decided). A point that has moved is used by no station; every station whose targets
/// change is computed again.
[[nodiscard]] StationingRun compute_stations(std::span<const Stationing> stationings, const ControlNetwork& network,
                                             const Instrument& instrument, const FreeStationOptions& options,
                                             Progress& progress);

/// Where a prism is that the station sees: a trolley's prism observed from beside the track. Covariance with the
/// station's own, m-frame.
struct LocatedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
[[nodiscard]] LocatedPoint locate(const StationResult& station, const Target& target, const Instrument& instrument);

}  // namespace versine::stationing
