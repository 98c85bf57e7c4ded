// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "versine/simulation/body.hpp"
#include "versine/simulation/recording.hpp"
#include "versine/simulation/scenario.hpp"

namespace versine::simulation {

/// Where on a line a distance lies: mileage, and the track of a network.
struct LinePlace {
  double mileage = 0.0;
  std::string track;
  double track_distance = 0.0;
};

/// A piece of a recording between two reversals on a network, or a whole recording on an alignment.
struct Piece {
  double begin = 0.0, end = 0.0;  ///< s since the start
  SpeedProfile motion;            ///< its time counts from `begin`
  Body body;
  std::function<LinePlace(double)> place;
};

/// Everything that the runs of a scenario share. Immutable after `prepare`.
class World {
 public:
  Equipment equipment;
  bool vehicle = false;
  track::Trolley trolley;
  Time start;
  TimeScale time_scale = TimeScale::gps;
  double duration = 0.0;  ///< s
  double truth_rate = 10.0;
  geodesy::LocalFrame frame{geodesy::Geodetic{}};
  std::vector<Piece> pieces;
  std::vector<Stop> stops;       ///< s since the start
  std::vector<double> sleepers;  ///< distances, m
  RailTruth rails;
  UniformSpline<6> curve;  ///< of the rails; only with `rails`
  sensors::ImuSeries ideal_imu;

  [[nodiscard]] const Piece& piece_at(double t) const;
  /// Along the line at s since the start; speed is positive forward for the body.
  [[nodiscard]] MotionState motion(double t) const;
  [[nodiscard]] BodyState state(double t) const;
  /// A point given in the v-frame's axes from the IMU, local frame.
  [[nodiscard]] Eigen::Vector3d point(double t, const Eigen::Vector3d& from_imu_v) const;
  [[nodiscard]] Eigen::Matrix3d C_lv(double t) const;
  [[nodiscard]] Eigen::Vector3d w_ie_l() const;
  [[nodiscard]] Time time(double t) const { return start + Duration::from_seconds(t); }
};

/// What follows from the rest of the world: the error-free IMU.
void complete(World& world);

// The sensors besides the IMU: each draws its own stream from the seed, so that one does not change another.
[[nodiscard]] Series<sensors::OdometerSample> observe_odometer(const World& world, const OdometerModel& model,
                                                               std::size_t index, std::uint64_t seed, Truth& truth);
[[nodiscard]] Series<sensors::GaugeSample> observe_gauge(const World& world, const GaugeModel& model,
                                                         std::uint64_t seed, Truth& truth);
[[nodiscard]] Series<sensors::RangeSample> observe_sleepers(const World& world, const SleeperModel& model,
                                                            std::uint64_t seed);
[[nodiscard]] Series<sensors::GnssSample> observe_gnss(const World& world, const GnssModel& model, std::uint64_t seed,
                                                       Truth& truth);
void observe_total_station(const World& world, const TotalStationModel& model, std::uint64_t seed,
                           SimulatedRecording& recording);
[[nodiscard]] AxleBoxRecording observe_axle_box(const World& world, const AxleBoxModel& model, std::uint64_t seed);

/// Puts a fault into the series; tells what it did.
void apply_fault(const Fault& fault, Time start, SimulatedRecording& recording);

}  // namespace versine::simulation
