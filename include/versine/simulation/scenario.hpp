// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/time.hpp"
#include "versine/design/alignment.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/simulation/irregularity.hpp"
#include "versine/track/trolley.hpp"

/// What is simulated: plain values in SI units and radians, filled in by a scenario file or by a program.
/// Distances are along the axis of the alignment, map metres from its start; positions on a body are in its frame v
/// (forward-right-down, origin in the IMU's reference point, track::Trolley).
namespace versine::simulation {

/// Stretch of the line, m, and of the recording, s.
struct Stretch {
  double from = 0.0, to = 0.0;
};

/// The track as it lies: design plus irregularities.
struct TrackModel {
  design::Alignment alignment;  ///< with a `crs` that is a projected map; without profile: level at `height`
  double height = 100.0;        ///< ellipsoidal, m, for alignments without a profile
  enum class CantPivot { axis, low_rail };
  CantPivot cant_pivot = CantPivot::axis;  ///< what keeps the design height where there is cant
  double gauge = 1.435;                    ///< m
  double grid = 0.1;                       ///< between the points at which the rails are computed, m

  Spectrum spectrum = Spectrum::none;
  double spectrum_factor = 1.0;  ///< of amplitudes
  double shortest = 1.0;         ///< wavelength of the spectrum, m
  double longest = 120.0;        ///< m
  std::uint64_t seed = 1;        ///< of the irregularities: the runs of a Monte Carlo set share one track
  std::vector<Defect> defects;
  std::optional<Deviations> table;  ///< added to spectrum and defects; zero outside its range

  double sleeper_spacing = 0.6;   ///< m
  double sleeper_jitter = 0.005;  ///< sigma of each sleeper's place, m
  std::vector<double> sleepers;   ///< their distances, m, instead of a spacing
};

/// An in-service vehicle: its frame rides on two bogies.
struct Vehicle {
  double bogie_distance = 19.0;  ///< m
  double axle_distance = 2.5;    ///< within a bogie, m
  Eigen::Vector3d imu{0.0, 0.0,
                      -1.2};  ///< IMU from the middle of the vehicle at running surface, m, forward-right-down
  geodesy::Euler mounting;    ///< of the IMU in the vehicle, `x_v = to_matrix(mounting) * x_b`
};

/// One leg of the motion: to a distance at a speed, then a stop.
struct Leg {
  double to = 0.0;            ///< distance along the axis, m; less than before means backwards
  double speed = 1.0;         ///< m/s
  double acceleration = 0.2;  ///< largest, m/s^2; braking the same
  double stop = 10.0;         ///< standing at the end, s
  double stop_every = 0.0;    ///< stops on the way, m apart; 0: none
  double stop_each = 0.0;     ///< their length, s
};

struct Motion {
  double start = 0.0;        ///< distance along the axis, m
  bool facing_back = false;  ///< the body faces decreasing distance
  double stand = 300.0;      ///< before the first leg, s: for the initial alignment
  std::vector<Leg> legs;
  double unevenness = 0.0;         ///< relative sigma of the speed (a person pushes), below 0.15
  double unevenness_period = 7.0;  ///< its typical period, s
};

/// IMU errors. Constant errors are drawn from their sigmas for each run, unless given by value.
struct ImuModel {
  double rate = 200.0;  ///< 1/s
  sensors::ImuErrors errors;
  /// How `bias_instability` varies: with its correlation time, or as flicker noise of that B.
  enum class Instability { gauss_markov, flicker };
  Instability instability = Instability::gauss_markov;
  std::optional<Eigen::Vector3d> gyro_bias, accelerometer_bias;  ///< rad/s, m/s^2
  std::optional<Eigen::Vector3d> gyro_scale, accelerometer_scale;
  Eigen::Vector3d gyro_temperature_factor = Eigen::Vector3d::Zero();           ///< rad/s per deg C
  Eigen::Vector3d accelerometer_temperature_factor = Eigen::Vector3d::Zero();  ///< m/s^2 per deg C
  double gyro_quantum = 0.0;             ///< of the accumulated angle, rad; 0: none
  double accelerometer_quantum = 0.0;    ///< of the accumulated velocity, m/s
  double clock_jitter = 0.0;             ///< sigma of each stamp, s
  double clock_drift = 0.0;              ///< relative: stamps run fast by this
  double vibration_gyro = 0.0;           ///< white noise density for each m/s of speed, rad/sqrt(s) / (m/s)
  double vibration_accelerometer = 0.0;  ///< m/s/sqrt(s) / (m/s)
};

/// Temperature of all sensors: linear with time, plus a daily-like wave.
struct Temperature {
  double start = 20.0;      ///< deg C
  double rate = 0.0;        ///< deg C/s
  double amplitude = 0.0;   ///< deg C
  double period = 86400.0;  ///< s
  [[nodiscard]] double at(double seconds) const;
};

/// A wheel with a counter. Wheel A1 (front, reference rail) and A3 (other rail); a vehicle's wheel likewise.
struct OdometerModel {
  enum class Wheel { a1, a3 };
  enum class Output { distance, pulses };
  Wheel wheel = Wheel::a1;
  Output output = Output::distance;
  double rate = 50.0;    ///< of `distance`, 1/s
  double quantum = 0.0;  ///< of a count, m; required for pulses
  double scale = 0.0;    ///< sigma of the constant scale error, 1
  std::optional<double> scale_value;
  double scale_walk = 0.0;      ///< random walk of the scale, 1/sqrt(m)
  double slip_per_km = 0.0;     ///< slip (wheel turns too far) and slide events (too little), alike, 1/km
  double slip_distance = 0.05;  ///< sigma of the distance gained or lost in one, m
};

struct GaugeModel {
  double rate = 20.0;          ///< 1/s
  double noise = 0.05e-3;      ///< m
  double offset_error = 0.0;   ///< sigma of the calibration's error, m
  double joint_spacing = 0.0;  ///< of welds, m; 0: none
  double joint_spike = 0.0;    ///< sigma of the spike there, m
};

struct SleeperModel {
  double rate = 100.0;        ///< 1/s
  double range = 0.30;        ///< from the sensor to ballast or slab, m
  double height = 0.08;       ///< of a sleeper or fastening above that, m
  double width = 0.25;        ///< along the track, m
  double noise = 2e-3;        ///< m
  double missed = 0.0;        ///< probability that a sleeper is not seen
  double false_per_km = 0.0;  ///< 1/km
};

struct GnssModel {
  double rate = 1.0;                        ///< 1/s
  Eigen::Vector3d antenna{0.0, 0.0, -1.0};  ///< from the IMU, v-frame, m
  bool velocity = true;
  double sigma_horizontal = 0.01, sigma_vertical = 0.02;              ///< white part with fixed ambiguities, m
  double correlated_horizontal = 0.008, correlated_vertical = 0.015;  ///< Gauss-Markov part, m
  double correlation_time = 120.0;                                    ///< s
  double sigma_velocity = 0.02;                                       ///< m/s
  double float_factor = 20.0;                                         ///< of both parts while ambiguities are float
  double refix_time = 30.0;                                           ///< float after an outage, mean, s
  double single_factor = 150.0;                                       ///< while there is no correction
  double single_per_h = 0.0;                                          ///< episodes without correction, 1/h
  double single_time = 20.0;                                          ///< their mean length, s
  double multipath_per_h = 0.0;                                       ///< episodes, 1/h
  double multipath_time = 20.0;                                       ///< mean length, s
  double multipath_sigma = 0.05;                                      ///< of their size, m, each axis
  double wrong_fix_per_h = 0.0;                                       ///< wrong ambiguities, told as fixed, 1/h
  double wrong_fix_time = 30.0;                                       ///< mean length, s
  double wrong_fix_smallest = 0.2, wrong_fix_largest = 2.0;           ///< m
  double lying_fix = 0.0;        ///< probability that a float or single epoch is told as fixed
  double sigma_factor = 1.0;     ///< told sigma times this is the true one; above 1 the receiver is optimistic
  std::vector<Stretch> outages;  ///< tunnels and bridges, distances, m
};

/// A total station on the trolley that finds itself between control points at stops, or a prism on it.
struct TotalStationModel {
  double every = 60.0;                    ///< between stationings, m; made at the first stop in reach
  double shortest_stop = 5.0;             ///< s: a stop shorter than this has no stationing
  Eigen::Vector3d place{0.0, 0.0, -0.8};  ///< of the instrument's centre from the IMU, v-frame, m
  geodesy::Euler mounting;                ///< of the instrument's axes in the v-frame
  enum class Output { positions, readings, both };
  Output output = Output::positions;
  double sigma_position = 0.6e-3;  ///< each axis, m
  double blunder = 0.0;            ///< probability that a position is wrong by `blunder_size`
  double blunder_size = 0.01;      ///< m
  // Readings to control points.
  double pair_spacing = 60.0;                   ///< of pairs of control points along the track, m
  double point_side = 3.5, point_height = 1.0;  ///< beside the axis and above the rails, m
  double sigma_point = 0.3e-3;                  ///< of the points' coordinates, m
  int targets = 8;                              ///< sighted from one place
  int faces = 1;                                ///< in which each point is read
  double collimation = 0.0, index_error = 0.0;  ///< of the instrument, rad; two faces cancel them
  double sigma_angle = 2.42e-6;                 ///< direction and zenith angle, both faces once (ISO 17123-3), rad
  double sigma_distance = 0.6e-3;               ///< m
  double sigma_distance_ppm = 1e-6;             ///< of the distance
  double refraction = 0.13;                     ///< coefficient k of the light's bending
  double sighting_blunder = 0.0;                ///< probability for each sighting
  double sighting_blunder_size = 0.02;          ///< m across or along the line
  int moved_points = 0;                         ///< control points that have moved since their survey
  double moved_by = 0.005;                      ///< m, in any direction
};

/// Axle-box acceleration of a wheel at A1: roughness, joints and switches.
struct AxleBoxModel {
  double rate = 20000.0;         ///< 1/s
  double roughness = 2.0;        ///< sigma at 1 m/s, m/s^2; grows with the speed
  std::vector<double> joints;    ///< distances, m
  std::vector<double> switches;  ///< distances of crossing noses, m
  double joint_impact = 8.0;     ///< at 1 m/s, m/s^2; grows with the speed
  double switch_impact = 15.0;   ///< m/s^2
  Stretch recorded;              ///< seconds of the recording; empty: all
};

/// A fault that is put into one series after everything else.
struct Fault {
  enum class Kind {
    gap,        ///< samples are missing
    duplicate,  ///< stamps repeat
    reorder,    ///< neighbouring samples change places
    stuck,      ///< values stay as they were
    delay,      ///< samples arrive in batches, stamped on arrival
    not_a_number,
    clock_step,  ///< stamps jump by `amount` and stay so to the end
    spike,       ///< values of `amount` are added, SI
  };
  enum class Sensor { imu, odometer, gauge, sleeper, gnss };
  Kind kind = Kind::gap;
  Sensor sensor = Sensor::imu;
  double at = 0.0;        ///< time since the start, s
  double duration = 1.0;  ///< s
  double amount = 0.1;    ///< s for clock_step and delay, SI for spike
};

/// Everything on the body that records.
struct Equipment {
  std::optional<ImuModel> imu;
  std::vector<OdometerModel> odometers;
  std::optional<GaugeModel> gauge;
  std::optional<SleeperModel> sleeper;
  std::optional<GnssModel> gnss;
  std::optional<TotalStationModel> total_station;
  std::optional<AxleBoxModel> axle_box;
  Temperature temperature;
  std::vector<Fault> faults;
};

struct Scenario {
  std::string name;
  TrackModel track;
  std::optional<Vehicle> vehicle;  ///< none: the trolley
  track::Trolley trolley;          ///< true geometry; what a job is told may differ
  Motion motion;
  Equipment equipment;
  Time start{1'400'000'000'000'000'000};  ///< of the recording
  TimeScale time_scale = TimeScale::gps;
  double truth_rate = 10.0;  ///< of the true trajectory, 1/s
};

}  // namespace versine::simulation
