// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "versine/georef/options.hpp"
#include "versine/network/path.hpp"

/// Filter and smoother on one path (Roth 2018 section III-F). State: distance d, speed s, unmodelled acceleration a
/// (the accelerometer's bias and the slope, or all of the acceleration when there is no IMU), and the time-correlated
/// part of the GNSS error along the track in units of its sigma. The GNSS error across the track does not depend on the
/// state to first order: a filter of its own follows it, for the likelihood of the path.
///
/// Between measurements the model is linear and the same for all paths, so that the IMU's samples are summed up once
/// (a Journey's epochs), the filter runs on the epochs only, and the smoothed states at every grid step follow exactly
/// from their two neighbouring epochs.
namespace versine::georef {

/// A time at which something was measured, or one second after the one before.
struct Epoch {
  std::int64_t step = 0;                            ///< grid steps since the journey's beginning
  Eigen::Vector2d input = Eigen::Vector2d::Zero();  ///< what the IMU adds to (d, s) since the epoch before
  std::optional<Eigen::Vector2d> position;          ///< fix, map m
  double sigma = 0.0;                               ///< m, of the fix, inflated
  std::size_t fix = 0;                              ///< its index in the recording
  std::optional<double> speed;                      ///< m/s
  double sigma_speed = 0.0;
  bool standing = false;       ///< known to stand: speed 0
  std::optional<double> turn;  ///< change of azimuth over the last `turn_seconds`, rad
  double turn_seconds = 0.0;
};

/// What every path hypothesis of a journey is judged by.
struct Epochs {
  Time start;
  double grid = 0.01;                                     ///< s
  std::vector<Epoch> epochs;                              ///< increasing steps; the first is step 0
  Eigen::Vector2d start_point = Eigen::Vector2d::Zero();  ///< first fix, however bad, map m
  double start_sigma = 100.0;                             ///< m
  std::vector<float> acceleration;                        ///< at each grid step, m/s^2 forward; empty: no IMU
  MotionModel motion;
  double correlation_time = 15.0;  ///< s, of the GNSS errors
};

struct FixResidual {
  std::size_t fix = 0;  ///< index in the recording
  std::size_t epoch = 0;
  float along = 0, across = 0;  ///< innovation, m (across: positive to the right)
  float sigma_along = 0, sigma_across = 0;
  float nis = 0;     ///< chi-square with 2 degrees of freedom
  float weight = 1;  ///< of the robust update; 0: rejected
};

using State4 = Eigen::Vector4d;
using Covariance4 = Eigen::Matrix4d;

/// Logarithms of what each kind of measurement makes of a path.
struct Evidence {
  double position = 0.0;   ///< fixes, along and across the track
  double speed = 0.0;      ///< GNSS, odometer, standstill
  double turn_rate = 0.0;  ///< gyro against the map's curvature
  double route = 0.0;      ///< prior: legs of switches, the journey before, fixes too poor for the filter
  [[nodiscard]] double likelihood() const { return position + speed + turn_rate; }
  [[nodiscard]] double total() const { return likelihood() + route; }
  friend Evidence operator-(const Evidence& a, const Evidence& b) {
    return {a.position - b.position, a.speed - b.speed, a.turn_rate - b.turn_rate, a.route - b.route};
  }
};

struct Filtered {
  std::vector<State4> predicted, updated;
  std::vector<Covariance4> predicted_covariance, updated_covariance;
  std::vector<double> colour_kept;  ///< share of the correlated GNSS error that went on from the epoch before
  std::vector<FixResidual> residuals;
  Evidence evidence;  ///< without route
};

/// What the filter carries from one epoch to the next, for those who feed it an epoch at a time (online.hpp).
struct TrackerState {
  State4 x = State4::Zero();
  Covariance4 P = Covariance4::Identity();
  double across = 0.0, across_variance = 1.0;  ///< correlated error across, in units of its sigma
  double last_sigma = 0.0;                     ///< of the fix before, m
  int astray = 0;                              ///< fixes in a row that agree with the track, not with the distance
  double log_likelihood = 0.0;                 ///< so far
  double nis = 0.0, weight = 1.0;              ///< of the last fix
};
/// The same filter, one epoch: predicts by `steps` of `model`'s grid (and its motion), then uses what was measured.
void advance(const network::PathCoordinates& path, const Epochs& model, const Options& options, const Epoch& epoch,
             std::int64_t steps, TrackerState& state);

struct Smoothed {
  std::vector<State4> state;
  std::vector<Covariance4> covariance;
  std::vector<Eigen::Matrix4d> gain;  ///< A_k to the next epoch: cov(k, k+1) = A_k P_(k+1)
};

/// `start`: distance at the first epoch, from projecting the first fixes. `weights`: of each fix from a smoothed pass
/// before, instead of the innovation's own.
[[nodiscard]] Filtered filter_on_path(const network::PathCoordinates& path, const Epochs& epochs,
                                      const Options& options, std::span<const double> weights = {});
/// Eq. 19.
[[nodiscard]] Smoothed smooth(const Epochs& epochs, const Filtered& filtered);

/// Robust weights of the fixes from smoothed residuals, one a residual of `filtered`.
[[nodiscard]] std::vector<double> smoothed_weights(const network::PathCoordinates& path, const Epochs& epochs,
                                                   const Options& options, const Filtered& filtered,
                                                   const Smoothed& smoothed);

/// The track at every grid step.
struct OnPath {
  std::vector<double> distance;  ///< m on the path, never decreasing
  std::vector<float> speed;      ///< m/s, never negative
  std::vector<float> sigma_distance, sigma_speed;
};
[[nodiscard]] OnPath densify(const Epochs& epochs, const Smoothed& smoothed);

}  // namespace versine::georef
