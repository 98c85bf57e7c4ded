// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/units.hpp"

namespace versine::gnss {

enum class Positioning {
  single,        ///< code of the rover alone, metres
  differential,  ///< code differences to the base, decimetres
  standing,      ///< carrier phase, the rover stands, millimetres
  kinematic,     ///< carrier phase, the rover moves, centimetres
};
enum class Ambiguities {
  floating,       ///< never fixed
  continuous,     ///< fixed epoch by epoch, the filter's float solution carried on
  instantaneous,  ///< fixed from each epoch alone
  hold,           ///< fixed values fed back into the filter: a wrong fix then persists
};
enum class Direction { forward, backward, combined };

/// What RTKLIB is told. Defaults are for a track trolley: slow, open sky or none, a base within a few kilometres,
/// processed afterwards in both directions, and rather no fix than a wrong one.
struct Options {
  Positioning positioning = Positioning::kinematic;
  Ambiguities ambiguities = Ambiguities::continuous;
  std::vector<std::string> systems = {"GPS", "Galileo", "GLONASS"};  ///< also "BeiDou", "QZSS", "SBAS"
  int frequencies = 2;                                               ///< 1: L1, 2: L1+L2 (E5b), 3: L1+L2+L5
  double elevation_mask = 15.0 * units::deg;                         ///< rad
  double snr_mask = 0.0;                                             ///< dB-Hz, at all elevations; 0: none
  double ratio = 3.0;                                                ///< of the second best to the best ambiguities
  int lock_epochs = 5;                       ///< that a satellite must be tracked before its ambiguity is fixed
  double fix_elevation = 15.0 * units::deg;  ///< below it ambiguities are not fixed, rad
  bool glonass_ambiguities = false;          ///< only between receivers of one make
  bool dynamics = false;                     ///< velocity and acceleration as states of the filter
  bool interpolate_base = false;             ///< the base has a lower rate than the rover
  double max_age = 30.0;                     ///< of the base's epoch, s
  std::optional<Eigen::Vector3d> base_ecef;  ///< m; none: from the header of its file
  bool average_base = false;  ///< none given and the header is not to be trusted: mean of its single points
  std::string rover_antenna, base_antenna;  ///< types in `antenna_file`; empty: no phase centre correction
  std::string antenna_file;                 ///< ANTEX
  double rover_antenna_height = 0.0, base_antenna_height = 0.0;  ///< of the reference point above the mark, m
};

/// Configuration file of rnx2rtkp 2.4.3, geographic coordinates, GPS time.
[[nodiscard]] std::string rtklib_configuration(const Options& options, Direction direction);

}  // namespace versine::gnss
