// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "versine/core/run_record.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/sensors/measurements.hpp"
#include "versine/stationing/readings.hpp"

namespace versine::simulation {

/// The rails as they lie, on a uniform grid of distances along the design axis.
struct RailTruth {
  std::vector<double> distance;                ///< along the axis, map m
  std::vector<double> mileage;                 ///< as the railway counts it, m
  std::vector<geodesy::Geodetic> left, right;  ///< gauge corner at the height of the running surface, WGS84
  std::vector<double> gauge, cross_level;      ///< m; cross level over 1.5 m, positive when the left rail is higher
  std::vector<double> level, alignment;        ///< deviation of the axis from its design, m: up, to the right
};

/// Where the body was along the line, at the times of the true trajectory.
struct ProgressPoint {
  Time time;
  double distance = 0.0;  ///< along the axis, m, of the body's reference (middle between A1 and A2, or of the vehicle)
  double mileage = 0.0;   ///< m
  double speed = 0.0;     ///< m/s, positive forward for the body
  std::string track;      ///< id of the network's track; empty on an alignment
  double track_distance = 0.0;  ///< from the track's own beginning, m
};

/// A time when the body stood.
struct Standstill {
  Time from, to;
  double distance = 0.0;  ///< m
};

/// A sighting of a total station with a blunder in it.
struct WrongSighting {
  std::string station, point;
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< across, up and along the line, m
};

struct Truth {
  geodesy::Trajectory trajectory;  ///< of the IMU's reference point and axes; covariances zero
  std::vector<ProgressPoint> progress;
  std::vector<Standstill> standstills;
  RailTruth rails;                                        ///< empty on a network
  std::vector<double> sleepers;                           ///< distances, m
  std::vector<std::pair<std::string, double>> constants;  ///< drawn errors by name ("gyro_bias_x"), SI and radians
  Series<sensors::ImuSample> bias;  ///< time-varying gyro (rad/s, as dtheta) and accelerometer (m/s^2) bias, 1/s
  std::vector<Eigen::Vector3d> gnss_error;  ///< of each epoch, north-east-down, m
  std::vector<WrongSighting> wrong_sightings;
  std::vector<std::string> moved_points;  ///< control points
};

struct AxleBoxRecording {
  Time start;
  double rate = 0.0;            ///< 1/s
  std::vector<float> vertical;  ///< m/s^2, positive down
};

/// What a trolley or a vehicle wrote, and what was true.
struct SimulatedRecording {
  TimeScale scale = TimeScale::gps;
  sensors::ImuSeries imu;
  std::vector<Series<sensors::OdometerSample>> odometers;  ///< in the order of Equipment::odometers
  Series<sensors::GaugeSample> gauge;
  Series<sensors::RangeSample> sleeper;
  Series<sensors::GnssSample> gnss;
  std::vector<sensors::LandmarkSample> landmarks;
  std::vector<stationing::Stationing> stationings;       ///< raw readings
  std::vector<stationing::ControlPoint> control_points;  ///< as told to the user, in the local frame at `origin`
  geodesy::Geodetic origin;                              ///< of that frame
  AxleBoxRecording axle_box;
  std::vector<Finding> faults;  ///< what Equipment::faults did
  Truth truth;
};

}  // namespace versine::simulation
