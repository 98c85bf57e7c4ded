// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/time.hpp"

/// Total stations and their control network. Everything here lives in one survey frame m: local Cartesian
/// north-east-down in real metres (geodesy::LocalFrame of the survey), so that no map scale or Earth curvature is left
/// in a distance or an angle.
///
/// Instrument frame s: x towards the zero of the horizontal circle, y to its right (the circle counts clockwise), z
/// down along the standing axis. A direction r and a zenith angle z point along (sin z cos r, sin z sin r, -cos z).
namespace versine::stationing {

/// A point with known coordinates.
struct ControlPoint {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< m-frame, m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m-frame, m^2; zero: taken as exact
};

/// Face I: the vertical circle left of the telescope, zenith angles 0 to pi; face II: the telescope reversed, zenith
/// angles pi to 2 pi, directions changed by pi.
enum class Face { one, two };

/// What the instrument read to one target, as it read it.
struct Sighting {
  std::string point;       ///< number of the target; empty: not told
  double direction = 0.0;  ///< horizontal circle, rad, clockwise
  double zenith = 0.0;     ///< vertical circle, rad from the zenith; above pi in face II
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< slope distance, m; NaN: angles only
  Face face = Face::one;
  int set = 0;                   ///< number of the set (round); 0: not told, one set
  double target_height = 0.0;    ///< of the prism above the point, along the plumb line, m
  double prism_constant = 0.0;   ///< still to be added to `distance`, m; 0 when the instrument has added it
  std::optional<Time> from, to;  ///< when the target stood still, for a prism on the trolley
  std::size_t line = 0;          ///< of the file it came from; 0: none
};

/// Air at the instrument, for the distance correction.
struct Atmosphere {
  double temperature = 12.0;  ///< deg C
  double pressure = 1013.25;  ///< hPa
  double humidity = 0.6;      ///< relative, 0 to 1
};

/// One set-up of the instrument with all that was read there.
/// Which way is up, as accelerometers on the trolley feel it while it stands.
struct FeltUp {
  Eigen::Vector3d up = -Eigen::Vector3d::UnitZ();  ///< in the accelerometers' axes, length 1
  double sigma = 0.0;                              ///< of what differs from station to station, each axis, rad
};

struct Stationing {
  std::string name;
  std::string mark;                      ///< number of the point it stands over; empty: none, as on a trolley
  double instrument_height = 0.0;        ///< of the instrument's centre above the station's mark, m; 0 on a trolley
  std::optional<Atmosphere> atmosphere;  ///< none: the instrument has corrected the distances itself
  std::optional<Time> from, to;          ///< when the trolley stood, in the recording's time
  std::optional<FeltUp> felt_up;         ///< of the trolley that carries the instrument
  std::vector<Sighting> sightings;
};

}  // namespace versine::stationing
