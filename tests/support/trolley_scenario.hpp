// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/sensors/imu_grade.hpp"
#include "versine/simulation/simulate.hpp"

namespace versine::simulation {

/// A trolley with a FOG unit that stands, drives `length` less 10 m at `speed`, and stops: half straight, half an arc.
inline Scenario trolley_on(double length, double speed, double stand) {
  Scenario s;
  s.track.alignment.crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
  s.track.alignment.horizontal = *design::HorizontalAxis::chain(
      {510000.0, 5300000.0, 0.7}, {design::line(length / 2), design::arc(length / 2, 800.0)});
  s.track.spectrum = Spectrum::china_ballastless;
  s.motion = {.start = 5.0, .stand = stand, .legs = {{.to = length - 5.0, .speed = speed, .stop = 10.0}}};
  s.equipment.imu = ImuModel{.errors = sensors::find_imu_grade("fog")->errors};
  return s;
}

}  // namespace versine::simulation
