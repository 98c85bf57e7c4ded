// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "versine/filter/linear_chain.hpp"

/// Error model of dead reckoning with gyro attitude and odometer (Jiang 2017 section 4.1): three small channels that do
/// not couple. Errors are estimate minus truth; attitude errors follow C_nb_hat = (I - [phi x]) C_nb.
namespace versine::fusion::landmark {

/// Vertical channel, eq. 18: down position (m), equivalent pitch error (rad; with the mounting angle about the lateral
/// axis), equivalent bias of the lateral gyro (rad/s).
namespace vertical {
inline constexpr int position = 0, pitch = 1, bias = 2, size = 3, observed = 1;
}
/// Level channel, eq. 23: north and east position (m), odometer scale error (1), equivalent heading error (rad),
/// equivalent bias of the vertical gyro (rad/s).
namespace level {
inline constexpr int north = 0, east = 1, scale = 2, heading = 3, bias = 4, size = 5, observed = 2;
}
/// Roll, which eq. 14 leaves out of the position: roll error (rad), equivalent bias of the longitudinal gyro (rad/s),
/// error of levelling by the lateral accelerometer (rad, constant). It gives the cross level and its sigma.
namespace roll {
inline constexpr int angle = 0, bias = 1, levelling = 2, size = 3, observed = 1;
}

using VerticalStep = filter::LinearStep<vertical::size, vertical::observed>;
using LevelStep = filter::LinearStep<level::size, level::observed>;
using RollStep = filter::LinearStep<roll::size, roll::observed>;
using VerticalEstimate = filter::Estimate<vertical::size>;
using LevelEstimate = filter::Estimate<level::size>;
using RollEstimate = filter::Estimate<roll::size>;

/// Integrals of the nominal motion over one step, from which transitions follow without approximation for any course of
/// speed and heading: tau counts from the start of the step.
struct Motion {
  double duration = 0.0;                                          ///< s
  double distance = 0.0;                                          ///< m: integral of v
  double distance_moment = 0.0;                                   ///< m s: integral of v tau
  Eigen::Vector2d displacement = Eigen::Vector2d::Zero();         ///< m: integral of v (cos psi, sin psi)
  Eigen::Vector2d displacement_moment = Eigen::Vector2d::Zero();  ///< m s: integral of v (cos psi, sin psi) tau

  /// A step at constant speed and heading.
  [[nodiscard]] static Motion straight(double duration, double speed, double heading);
};

/// Densities of the noises that drive the channels. All SI and radians.
struct DrivingNoise {
  double random_walk = 0.0;    ///< gyro, rad/sqrt(s)
  double bias_walk = 0.0;      ///< equivalent gyro bias, rad/s/sqrt(s)
  double scale_walk = 0.0;     ///< odometer scale, 1/sqrt(s) (eq. 11)
  double path_walk = 0.0;      ///< wheels against the direction they point in, m/sqrt(m), lateral and vertical
  double distance_walk = 0.0;  ///< odometer, m/sqrt(m), along the track
};
/// What the reduced model leaves out, as noise spread over a stretch (landmark_validity.hpp): 0 on straight track.
struct ModelNoise {
  double pitch_walk = 0.0;         ///< rad/sqrt(m), mounting angles turned by a change of cant
  double heading_walk = 0.0;       ///< rad/sqrt(m)
  double lateral_bias_walk = 0.0;  ///< rad/s/sqrt(m), Earth rate and heading rate through the attitude errors
  double vertical_bias_walk = 0.0;
};

/// Eqs. 19 and 24 over one step. The noise is exact for constant speed and heading within the step.
[[nodiscard]] VerticalStep vertical_step(const Motion& m, const DrivingNoise& noise, const ModelNoise& model = {});
[[nodiscard]] LevelStep level_step(const Motion& m, const DrivingNoise& noise, const ModelNoise& model = {});
[[nodiscard]] RollStep roll_step(double duration, const DrivingNoise& noise);

/// Eq. 21 and eq. 24: estimated position minus landmark, n-frame, m; `covariance` of the landmark.
[[nodiscard]] filter::LinearObservation<vertical::size, 1> observe_down(double z, double variance);
[[nodiscard]] filter::LinearObservation<level::size, 2> observe_level(const Eigen::Vector2d& z,
                                                                      const Eigen::Matrix2d& covariance);
/// Roll from the accelerometers while standing minus roll as reckoned (phi turns the estimate into the truth).
[[nodiscard]] filter::LinearObservation<roll::size, 1> observe_roll(double z, double variance);

}  // namespace versine::fusion::landmark
