// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "versine/core/error.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/inertial/standstill.hpp"
#include "versine/sensors/imu_grade.hpp"

namespace versine::inertial {

/// The attitude at one time, with what is known about its errors.
struct InitialAlignment {
  Time time;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< of the phi-angle about north, east, down, rad
  std::string method;                               ///< "gyrocompass", "course", "given", "previous segment"
};

/// Coarse alignment of a standing IMU at the beginning of `standing`. The gyros carry the specific force into a frame
/// that does not turn in inertial space; there gravity turns with the Earth, and the rotation that makes the measured
/// vertical follow it is level and heading at once (alignment in the inertial frame, Groves 2013 section 5.6.2). A
/// vehicle that rocks, because of people or an engine, does not disturb it, as it does a mean of the rates. The sigmas
/// follow from the IMU's errors, the duration, and the unrest that is left: level `bias / g`, heading
/// `rate error / (omega cos latitude)`. Fails with the reason when an instrument that resolves no Earth rate (heading
/// sigma above 30 degrees) is asked for heading, or when the force is not that of gravity.
[[nodiscard]] Expected<InitialAlignment> gyrocompass(const sensors::ImuSeries& imu, const Interval& standing,
                                                     const geodesy::Geodetic& position,
                                                     const sensors::ImuErrors& errors,
                                                     const geodesy::Ellipsoid& ellipsoid = geodesy::wgs84);

/// Level from the mean specific force (less a known acceleration in b), with a heading from elsewhere.
[[nodiscard]] Expected<InitialAlignment> level_with_heading(const sensors::ImuSeries& imu, const Interval& span,
                                                            double heading, double heading_sigma,
                                                            const sensors::ImuErrors& errors,
                                                            const Eigen::Vector3d& acceleration_b = {0, 0, 0});

struct CourseOptions {
  double minimum_speed = 1.5;       ///< m/s; slower course angles are noise
  double search = 600.0;            ///< s after the start within which the vehicle must have moved
  double use = 20.0;                ///< s of motion whose course is averaged
  double vehicle_heading_in_b = 0;  ///< rad; yaw of the vehicle's forward axis in the IMU's level frame
};

/// Heading at `start` from the GNSS course while driving forward: the gyros carry the heading from the start to every
/// GNSS epoch in motion, and the mean difference to the course is the heading at the start. Works from standstill and
/// in motion. Fails when there is no motion to take a course from.
[[nodiscard]] Expected<InitialAlignment> align_by_course(const sensors::ImuSeries& imu, Time start,
                                                         const Series<sensors::GnssSample>& gnss,
                                                         const sensors::ImuErrors& errors,
                                                         const CourseOptions& options = {},
                                                         const geodesy::Ellipsoid& ellipsoid = geodesy::wgs84);

}  // namespace versine::inertial
