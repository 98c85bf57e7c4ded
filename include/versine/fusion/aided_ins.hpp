// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/solution.hpp"
#include "versine/inertial/alignment.hpp"
#include "versine/inertial/standstill.hpp"
#include "versine/sensors/imu_grade.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::fusion {

/// Recordings of one run on one clock, checked and repaired by sensors' integrity check. Only the IMU must be there;
/// where the others may be empty the run fails only if nothing at all tells position.
struct AidedInsInput {
  sensors::ImuSeries imu;
  Series<sensors::GnssSample> gnss;
  Series<sensors::OdometerSample> odometer;
  Series<sensors::SpeedSample> speed;
  Series<sensors::LandmarkSample> landmarks;
  Series<sensors::HeadingSample> heading;  ///< of the vehicle's forward axis
  /// Times of the first IMU samples after gaps too long to bridge: there the inertial part starts anew, and nothing
  /// is integrated or smoothed across. IMU intervals longer than `AidedInsOptions::longest_imu_interval` start a
  /// segment by themselves.
  std::vector<Time> segment_starts;
};

enum class HeadingSource {
  automatic,    ///< gyrocompass when standing and the gyros can; else a given value; else heading samples; else course
  gyrocompass,  ///< Earth rate while standing
  course,       ///< GNSS course in motion, carried back by the gyros
  given,        ///< `initial_heading`: a value measured or read from the nominal track azimuth
};
enum class SmootherKind { none, bryson_frazier, rauch_tung_striebel };
enum class OdometerUse { distance, speed };
enum class BiasInstability {
  gauss_markov,  ///< with the grade's correlation time
  flicker,       ///< 1/f noise with a floor of the Allan deviation of 0.664 times the grade's bias instability
};
enum class RobustWeight { none, huber };

/// Where things are fixed: lever arms in the b-frame from the IMU's centre, m, and their sigma when they are
/// estimated (zero sigma: known, not estimated).
struct LeverArm {
  Eigen::Vector3d l_b = Eigen::Vector3d::Zero();
  double sigma = 0.0;
};

struct AidedInsOptions {
  // --- the IMU and how it sits
  sensors::ImuErrors imu_errors = sensors::find_imu_grade("navigation-rlg")->errors;
  BiasInstability instability = BiasInstability::gauss_markov;  ///< how the slow part of the biases varies
  geodesy::Euler mounting;                                      ///< attitude of the IMU (b) in the vehicle (v), rad
  double mounting_sigma = 0.0;  ///< rad; pitch and yaw of the mounting are estimated when positive
  LeverArm gnss_lever;          ///< to the antenna's phase centre
  LeverArm wheel_lever;         ///< to the wheel point of odometer and constraint: the middle of the wheelbase
  LeverArm landmark_lever;      ///< to the total station's centre or the prism; its sigma must be zero
  Eigen::Quaterniond q_bs = Eigen::Quaterniond::Identity();  ///< attitude of the total station (s) against b

  // --- initial alignment
  HeadingSource heading_source = HeadingSource::automatic;
  std::optional<double> initial_heading;              ///< rad, of the vehicle's forward axis at the start
  double initial_heading_sigma = 0.02;                ///< rad
  double alignment_duration = 300.0;                  ///< s of the first standstill used for coarse alignment
  std::optional<geodesy::Geodetic> initial_position;  ///< when no aiding tells it at the start
  double initial_position_sigma = 1.0;                ///< m
  inertial::CourseOptions course;

  // --- GNSS
  bool use_gnss_position = true;
  bool use_gnss_velocity = true;
  double gnss_sigma_scale = 1.0;    ///< multiplies the sigmas told by the receiver
  double gnss_sigma_minimum = 0.0;  ///< m; floor of each component
  double gnss_bias = 0.0;           ///< m; sigma of a slowly varying position bias, estimated when positive
  double gnss_bias_up = 0.0;        ///< m; the same of heights; 0: as gnss_bias
  double gnss_bias_time = 300.0;    ///< s; its correlation time
  /// North-east-down, m.
  [[nodiscard]] Eigen::Vector3d gnss_bias_sigma() const {
    return {gnss_bias, gnss_bias, gnss_bias_up > 0.0 ? gnss_bias_up : gnss_bias};
  }

  // --- odometer and speed
  OdometerUse odometer_use = OdometerUse::distance;
  double odometer_sigma = 0.0005;        ///< m; error of each reading (pulse length / sqrt 12, or time tag times speed)
  double odometer_random_walk = 0.0005;  ///< m per sqrt(m) travelled: slip and uneven rolling
  double odometer_scale_sigma = 0.01;    ///< 1; of the scale factor before it is estimated
  double odometer_scale_walk = 0.0;      ///< 1/sqrt(s); drift of the scale factor (wear, temperature, tyre)
  double speed_sigma = 0.1;              ///< m/s; of a speed sample
  double speed_correlation_time = 0.0;   ///< s; errors of neighbouring speed samples are alike for this long

  // --- non-holonomic constraint: no motion sideways and upwards at the wheel point
  bool constraint = true;
  double constraint_sigma = 0.002;      ///< m/s; floor
  double constraint_angle = 0.001;      ///< rad; sideways motion per forward motion (track irregularity, side slip)
  double constraint_correlation = 1.5;  ///< m; over this distance that angle stays alike (wheelbase)
  double constraint_interval = 0.0;     ///< s; 0: at every covariance step
  /// rad; widens the constraint's gate only. Wheels on short irregularities go sideways and back: single angles are far
  /// larger than what is left of them over some metres, which is what constraint_angle stands for. They are no faults.
  double constraint_peak = 0.0;
  /// m sqrt(m); wheels that guide a beam along a rail stray from where it points, but always come back: their middle is
  /// never far from the sum of its way. How far, as a mean over one metre. When positive the constraint is that sum,
  /// and constraint_sigma and _angle are only what adds up over a run; 0: the velocity alone, for wheels that slip.
  double constraint_wander = 0.0;

  // --- standing still
  bool zero_velocity = true;
  /// After `alignment_duration`, too. false: a vehicle that stands shows the drift of its unaided IMU.
  bool zero_velocity_after_alignment = true;
  /// m/s; of the mean velocity over an interval (or over as much of it as the accelerometers' noise lets be averaged)
  double zero_velocity_sigma = 0.002;
  double zero_rate_sigma = 2e-4;  ///< rad/s; noise of the mean rate in one covariance step beyond the gyros' own
  double zero_interval = 0.5;     ///< s between updates while standing
  /// m; how far the vehicle's place may be from its mean place of a standstill (rocking). While it stands its position
  /// is that constant, not the integral of a velocity. It adds to the sigma of the mean velocity.
  double zero_position_sigma = 1e-4;
  inertial::StandstillOptions standstill;

  // --- gates and weights
  double gate_probability = 1e-5;  ///< chance that a good measurement is rejected
  RobustWeight robust = RobustWeight::none;
  int most_rejections = 10;  ///< after so many in a row of one sensor the filter, not the sensor, is doubted,
  /// s; of positions, if the rejections have lasted this long, or as long as the segment before. 0: as long as the
  /// accelerometers' bias alone keeps the position within 0.3 m, a small wrong ambiguity: 50 s of a ring-laser IMU, 2 s
  /// of a consumer one.
  double doubt_after = 0.0;
  int monitor_length = 30;  ///< innovations of one sensor whose mean is watched for slow faults; 0: off

  // --- numbers
  /// m/s^2 per root of the metres travelled; change of gravity against its normal value, in size and direction. It acts
  /// on the accelerometers' biases: without it a filter believes that it sees a bias turn in a canted curve.
  double gravity_walk = 1.6e-6;
  double covariance_rate = 10.0;       ///< Hz
  double longest_imu_interval = 0.05;  ///< s (or five nominal intervals, if longer); longer: a new segment
  SmootherKind smoother = SmootherKind::bryson_frazier;
  double output_rate = 0.0;            ///< Hz of the trajectory; 0: at every IMU sample
  double sensor_error_interval = 1.0;  ///< s between sensor error samples
  double innovation_interval = 0.0;    ///< s between kept innovations of odometer, constraint and standstill; 0: all
  double chain_rate = 0.0;             ///< Hz of the error chain; 0: none
  bool keep_forward = false;           ///< the forward trajectory too
  bool dead_reckoning = false;         ///< also Chen 4.3: smoothed attitude and odometer
};

/// How one segment of the run began.
struct SegmentStart {
  Time from, to;
  inertial::InitialAlignment alignment;  ///< coarse
  /// Sigma of the phi-angle (north, east, down) that the filter reached at the end of the first standstill: the fine
  /// alignment. Empty when the segment did not begin standing.
  std::optional<Eigen::Vector3d> fine_sigma;
  std::optional<geodesy::Euler> fine_attitude;
};

/// Consistency of one sensor's innovations over the run.
struct SensorStatistics {
  std::string sensor;
  std::size_t used = 0, rejected = 0;
  double mean_nis_per_row = 0.0;    ///< of those used; 1 when noise and model agree
  double lower = 0.0, upper = 0.0;  ///< 95 % bounds of it if the model were right
};

struct AidedInsResult {
  Solution solution;
  std::optional<geodesy::Trajectory> dead_reckoned;
  std::vector<SegmentStart> segments;
  std::vector<SensorStatistics> statistics;
  std::vector<inertial::Interval> standstills;
  SmootherKind smoother_used = SmootherKind::none;
};

/// Sees a run before it is finished.
class RunWatch {
 public:
  virtual ~RunWatch() = default;
  /// The forward filter's estimate of now, some hundred steps after the one before, and what was found until
  /// then: standstills of the whole recording, innovations and rejections so far.
  virtual void forward(const geodesy::TrajectoryPoint& now, const AidedInsResult& so_far) = 0;
};

/// Aided inertial navigation over a whole recording (Chen 2018 section 4.3): alignment, error-state Kalman filter
/// forward with every aid at its own time, smoother backward. Deterministic. Fails with an Error when the input does
/// not suffice (no IMU, no position from anything, no heading) or was cancelled; a rejected measurement is in the
/// record. REQUIRES strictly increasing series.
[[nodiscard]] Expected<AidedInsResult> run_aided_ins(const AidedInsInput& input, const AidedInsOptions& options,
                                                     Progress& progress, Log& log, RunWatch* watch = nullptr);

}  // namespace versine::fusion
