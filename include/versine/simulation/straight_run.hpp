// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/sensors/measurements.hpp"

/// A trolley on straight level track that stands at landmarks: the case for which accuracy has closed forms (Jiang 2017
/// sections 5 and 6.1). Cheap enough for thousands of runs; `simulate()` is the general simulator.
namespace versine::simulation {

struct StraightRun {
  double latitude = 0.0;        ///< rad
  double heading = 0.0;         ///< rad
  double speed = 1.0;           ///< m/s between landmarks, from the first moment
  std::vector<double> spacing;  ///< m from landmark to landmark; one more landmark than values
  double stand_first = 1.2;     ///< s before moving off
  double stand = 1.2;           ///< s at each further landmark
  double rate = 100.0;          ///< of IMU, 1/s
  double odometer_rate = 20.0;  ///< 1/s
  sensors::TriadErrors gyro;    ///< bias drawn; `bias_instability` as B of flicker noise or as Gauss-Markov
  bool flicker = false;
  sensors::TriadErrors accelerometer;  ///< bias and random walk only
  double scale = 0.0;                  ///< sigma of the odometer's scale error
  double scale_walk = 0.0;             ///< 1/sqrt(s)
  double distance_walk = 0.0;          ///< m/sqrt(m), odometer besides its scale
  double path_walk = 0.0;              ///< m/sqrt(m), body against the direction it points in, sideways and up
  double landmark = 0.0;               ///< sigma, m, each direction
};

struct StraightRecording {
  sensors::ImuSeries imu;
  Series<sensors::OdometerSample> odometer;
  Series<sensors::LandmarkSample> landmarks;
  std::vector<geodesy::Geodetic> truth;  ///< at each IMU sample, of the body
  std::vector<double> distance;          ///< m from the start, at each IMU sample
  geodesy::Euler attitude;               ///< true, throughout
};

/// Equal for equal arguments, to the bit.
[[nodiscard]] StraightRecording simulate_straight(const StraightRun& run, std::uint64_t seed);

}  // namespace versine::simulation
