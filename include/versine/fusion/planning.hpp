// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Closed forms of the accuracy of landmark dead reckoning between two landmarks (Jiang 2017 section 5): smoothed
/// variance of position after filter and smoother, for a straight interval at constant speed. Exact for that model;
/// chained intervals, which share what they learn about the gyro, are in planning_chain.hpp.
namespace versine::fusion {

/// Errors that drive the lateral direction (heading and vertical gyro) or the vertical one (pitch and lateral gyro).
/// All are standard deviations; SI and radians.
struct CrossErrors {
  double start_position = 0.0;  ///< m, at the first landmark before it is smoothed (sqrt of p_r)
  double landmark = 0.0;        ///< m, of the observation at the far landmark (sigma_r)
  double angle = 0.0;           ///< rad, of the equivalent heading or pitch at the start
  double bias = 0.0;            ///< rad/s, of the equivalent gyro bias
  double random_walk = 0.0;     ///< rad/sqrt(s), of the equivalent gyro noise
};

/// Errors that drive the longitudinal direction.
struct LongitudinalErrors {
  double start_position = 0.0;  ///< m
  double landmark = 0.0;        ///< m
  double scale = 0.0;           ///< 1, of the odometer's scale factor at the start
  double scale_walk = 0.0;      ///< 1/sqrt(s), its random walk
};

/// Smoothed position variance, m^2, at time t (s) of an interval of duration T at speed v (m/s) with one observation,
/// at T: Jiang eq. 40 (vertical) and eq. 45 (lateral) with the sign of their last term corrected.
/// REQUIRES 0 <= t <= T, v > 0, start_position > 0 or landmark > 0.
[[nodiscard]] double cross_variance(const CrossErrors& e, double v, double T, double t);

/// The same along the track: Jiang eq. 44.
[[nodiscard]] double longitudinal_variance(const LongitudinalErrors& e, double v, double T, double t);

/// What gyrocompassing leaves in heading, rad: phi_D = bias / (omega_ie cos latitude) (Titterton; Jiang section 5).
/// `bias` is that of the gyro that points east, rad/s. REQUIRES |latitude| < pi/2.
[[nodiscard]] double gyrocompass_heading_error(double bias, double latitude);

/// Sigma of the equivalent gyro bias (rad/s) that remains after alignment: the gyro's own and what the Earth's rate
/// contributes through the attitude errors (Jiang eq. 6).
struct EquivalentBias {
  double lateral = 0.0;        ///< of the lateral gyro (vertical channel), root of the sum of squares
  double vertical = 0.0;       ///< of the vertical gyro (lateral channel), root of the sum of squares
  double lateral_worst = 0.0;  ///< the same as a sum of magnitudes
  double vertical_worst = 0.0;
  /// Heading as at the alignment: there the error in heading cancels the east gyro's bias, and only what changes since
  /// remains, so that this many rad/s of lateral bias come back with a turn (|1 - cos| of it, at most twice the bias).
  double returns_with_turn = 0.0;
};
/// `level`: sigma of each level angle, rad; `heading`: of the track, rad from north; `heading_error`: sigma, rad.
[[nodiscard]] EquivalentBias equivalent_bias(double gyro_bias, double level, double heading_error, double latitude,
                                             double heading);

}  // namespace versine::fusion
