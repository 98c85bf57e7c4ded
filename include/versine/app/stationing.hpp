// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/core/progress.hpp"
#include "versine/core/run_record.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/inertial/standstill.hpp"
#include "versine/io/control_points.hpp"
#include "versine/stationing/free_station.hpp"
#include "versine/stationing/network_adjustment.hpp"

namespace versine::app {

/// Raw total-station readings as a job names them: `[total_station]` of a survey, or the whole job of
/// `versine stationing`.
struct StationingProcessing {
  enum class Arrangement {
    on_trolley,  ///< the instrument stands on the trolley and finds itself between control points
    beside,      ///< the instrument stands beside the track and sees a prism on the trolley
  };
  std::vector<InputPath> readings;
  std::vector<InputPath> control;
  std::map<std::string, std::string> columns;  ///< foreign headers of the readings
  std::string crs;                             ///< of map coordinates
  std::optional<Eigen::Vector3d> origin;       ///< latitude, longitude (deg), height (m) of north, east, up coordinates
  double control_sigma = 0.5 * units::mm;
  TimeScale time_scale = TimeScale::gps;  ///< of the readings' times
  Arrangement arrangement = Arrangement::on_trolley;
  std::string prism = "PRISM";  ///< number of the trolley's prism, beside
  /// Roll, pitch, yaw of the instrument against the IMU, deg; given, the attitude is handed over too (on_trolley).
  std::optional<Eigen::Vector3d> mounting;
  bool check_control = false;   ///< of a survey: adjust stations, points and trajectory together
  double mounting_sigma = 0.0;  ///< rad, each axis; the same error at every station
  stationing::Instrument instrument;
  stationing::FreeStationOptions options;
};
void describe(ConfigVisitor& v, StationingProcessing& s);

struct StationingOutcome {
  stationing::StationingRun run;
  std::vector<stationing::ReducedStation> reduced;  ///< what network adjustment takes
  stationing::ControlNetwork network;
  geodesy::LocalFrame frame{geodesy::Geodetic{}};  ///< m-frame of everything in `run`
  std::vector<sensors::LandmarkSample> landmarks;  ///< what a survey takes; only stations with times
  RunRecord record;
};

/// From files to stations and landmark updates. A station that cannot be computed is a rejection with its reason, not
/// the end of the run; the run fails when none can, or when a file cannot be read. `prepare`, when given, adds to the
/// readings what others know of the stations (feel_up).
[[nodiscard]] Expected<StationingOutcome> process_stationing(
    const StationingProcessing& processing, Progress& progress, Log& log,
    const std::function<void(std::span<stationing::Stationing>)>& prepare = {});

/// The same from values: what a survey of simulated readings calls.
[[nodiscard]] StationingOutcome compute_landmarks(std::vector<stationing::Stationing> stationings,
                                                  stationing::ControlNetwork network, const geodesy::LocalFrame& frame,
                                                  const StationingProcessing& processing, Progress& progress);

/// Drops landmarks during which the trolley did not stand, as IMU and odometer saw it (inertial::find_standstills);
/// each is a rejection "not standing".
[[nodiscard]] std::vector<Rejection> require_standstill(std::vector<sensors::LandmarkSample>& landmarks,
                                                        const std::vector<inertial::Interval>& standstills);

/// Position and attitude of the IMU b from those of the instrument s: lever arm `l_bs_b` (from the IMU to the
/// instrument, b-frame, m) and mounting `q_bs` (s to b), with their sigmas; for a check, or for software that takes no
/// lever arm.
struct BodyPose {
  geodesy::Geodetic position;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), attitude_covariance = Eigen::Matrix3d::Zero();
};
[[nodiscard]] BodyPose to_body(const sensors::LandmarkSample& landmark, const Eigen::Vector3d& l_bs_b,
                               const Eigen::Quaterniond& q_bs, double lever_sigma, double mounting_sigma);

}  // namespace versine::app
