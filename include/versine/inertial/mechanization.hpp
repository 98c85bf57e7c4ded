// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "versine/geodesy/ellipsoid.hpp"
#include "versine/inertial/nav_state.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::inertial {

/// Motion of the body over one interval, ready to be integrated: a rotation vector and a velocity increment that hold
/// for a rate and a specific force that are constant over the interval (coning and sculling are in them already).
/// Because they are constant, the interval may be cut anywhere: two parts give what the whole gives.
struct Increment {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< of b against i over the interval, b-frame at its start, rad
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< integral of the specific force, b-frame, m/s
  double dt = 0.0;                                     ///< s, from a difference of integer nanoseconds
};

/// Takes the IMU's known errors off a sample that covers `dt` seconds.
[[nodiscard]] Increment corrected(const sensors::ImuSample& sample, double dt, const ImuCorrection& correction);

/// Adds to `current` the coning and sculling that a rate and a force varying linearly over the two intervals produce
/// (Savage 1998; the factor is 1/12 when both last equally long). A `previous` with dt = 0 means that there is none.
[[nodiscard]] Increment with_coning_and_sculling(const Increment& previous, const Increment& current);

/// The share of an interval, 0 to 1.
[[nodiscard]] inline Increment part(const Increment& whole, double share) {
  return {whole.rotation * share, whole.velocity * share, whole.dt * share};
}

/// What a step of the mechanisation passes on to the error dynamics, beside the new state.
struct StepGeometry {
  geodesy::LocalEarth earth;           ///< at the start of the interval
  Eigen::Matrix3d C_nb_middle;         ///< attitude in the middle of the interval
  Eigen::Vector3d velocity_increment;  ///< integral of the specific force in n, m/s
  Eigen::Vector3d v_middle;            ///< velocity in the middle of the interval, n-frame, m/s
  Eigen::Vector3d omega_ie, omega_en;  ///< Earth rate and transport rate in n, rad/s
  double height = 0.0;                 ///< m
};

/// Strapdown mechanisation in the n-frame over one interval (Savage 1998; Groves 2013 section 5.5): Earth rate,
/// transport rate, Coriolis, normal gravity with height and its lean. Errors of third order in dt: an error-free
/// recording at 200 Hz integrates to its truth within the tolerances of tests/inertial/mechanization_test.cpp.
/// `C_nb` is the matrix of `state.q_nb` on entry and of the result on return (kept beside it only to save the
/// conversion). The time of the result is `state.time + dt` rounded to nanoseconds; callers that know the sample's
/// own stamp set it.
[[nodiscard]] NavState mechanize(const NavState& state, const Increment& increment, const geodesy::Ellipsoid& ellipsoid,
                                 Eigen::Matrix3d& C_nb, StepGeometry& geometry);

/// The same without the by-products.
[[nodiscard]] NavState mechanize(const NavState& state, const Increment& increment,
                                 const geodesy::Ellipsoid& ellipsoid = geodesy::wgs84);

/// Integrates all samples later than `start.time`, in order: pure inertial navigation. One state for each sample.
[[nodiscard]] std::vector<NavState> integrate(const NavState& start, const sensors::ImuSeries& imu,
                                              const ImuCorrection& correction = {},
                                              const geodesy::Ellipsoid& ellipsoid = geodesy::wgs84);

/// Earth rate in n (Groves eq. 2.123) and transport rate (Groves eq. 5.44), rad/s.
[[nodiscard]] Eigen::Vector3d earth_rate(const geodesy::LocalEarth& earth, double omega);
[[nodiscard]] Eigen::Vector3d transport_rate(const geodesy::LocalEarth& earth, double height,
                                             const Eigen::Vector3d& v_eb_n);

}  // namespace versine::inertial
