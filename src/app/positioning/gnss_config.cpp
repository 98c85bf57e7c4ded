// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "versine/app/gnss.hpp"
#include "versine/core/units.hpp"

namespace versine::app {
namespace {

using gnss::Ambiguities;
using gnss::Direction;
using gnss::Positioning;

constexpr std::array<std::pair<std::string_view, Positioning>, 4> positionings{
    {{"single", Positioning::single},
     {"differential", Positioning::differential},
     {"static", Positioning::standing},
     {"kinematic", Positioning::kinematic}}};
constexpr std::array<std::pair<std::string_view, Ambiguities>, 4> resolutions{
    {{"float", Ambiguities::floating},
     {"continuous", Ambiguities::continuous},
     {"instantaneous", Ambiguities::instantaneous},
     {"hold", Ambiguities::hold}}};
constexpr std::array<std::pair<std::string_view, Direction>, 3> directions{
    {{"forward", Direction::forward}, {"backward", Direction::backward}, {"combined", Direction::combined}}};

void describe_base(ConfigVisitor& v, GnssProcessing& g) {
  v.value("base_ecef_m", g.base_ecef, {.doc = "Position of the base's mark, Earth-centred x, y, z.", .unit = "m"});
  Eigen::Vector3d degrees = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::optional<Eigen::Vector3d> written;
  if (g.base_geodetic) {
    degrees = {g.base_geodetic->x() / units::deg, g.base_geodetic->y() / units::deg, g.base_geodetic->z()};
    written = degrees;
  }
  v.value(
      "base_position", written,
      {.doc = "The same as latitude and longitude (deg) and ellipsoidal height (m). Without either, the position in "
              "the header of the base's file."});
  if (written) g.base_geodetic = Eigen::Vector3d(written->x() * units::deg, written->y() * units::deg, written->z());
  v.value("average_base", g.options.average_base,
          {.doc = "Take the mean of the base's single points (metres off) when no position is given."});
}

}  // namespace

void describe(ConfigVisitor& v, GnssProcessing& g) {
  auto& o = g.options;
  v.value("rover", g.rover,
          {.doc = "Observations of the rover: RINEX 2 or 3, Hatanaka, u-blox or NovAtel raw; plain, .gz or .zst.",
           .example = "[\"rover.obs\"]"});
  v.value("base", g.base, {.doc = "Observations of the base.", .example = "[\"base.obs\"]"});
  v.value("navigation", g.navigation,
          {.doc = "RINEX navigation files; raw files bring their own.", .example = "[\"brdc.nav\"]"});
  v.choice<Positioning>("mode", o.positioning, positionings, {.doc = "What is computed."});
  v.choice<Direction>("direction", g.direction, directions,
                      {.doc = "Order in time; combined also compares both directions and marks doubtful fixes."});
  v.choice<Ambiguities>("ambiguities", o.ambiguities, resolutions, {.doc = "How carrier-phase ambiguities are fixed."});
  v.value("systems", o.systems, {.doc = "Satellite systems: GPS, Galileo, GLONASS, BeiDou, QZSS, SBAS."});
  v.value("frequencies", o.frequencies, {.doc = "1: L1, 2: L1 and L2 or E5b, 3: also L5.", .min = 1, .max = 3});
  v.value("elevation_mask_deg", o.elevation_mask,
          {.doc = "Satellites below are not used.", .unit = "deg", .scale = units::deg, .min = 0, .max = 60});
  v.value("snr_mask_dbhz", o.snr_mask,
          {.doc = "Weaker signals are not used; 0: all.", .unit = "dB-Hz", .min = 0, .max = 60});
  v.value("ratio", o.ratio,
          {.doc = "Smallest ratio of the second best to the best ambiguities for a fix.", .min = 1, .max = 100});
  v.value("lock_epochs", o.lock_epochs, {.doc = "Epochs of lock before an ambiguity is fixed.", .min = 0, .max = 1000});
  v.value(
      "fix_elevation_deg", o.fix_elevation,
      {.doc = "Ambiguities of lower satellites stay float.", .unit = "deg", .scale = units::deg, .min = 0, .max = 60});
  v.value("glonass_ambiguities", o.glonass_ambiguities,
          {.doc = "Fix GLONASS ambiguities too; only between receivers of one make."});
  v.value("dynamics", o.dynamics, {.doc = "Velocity and acceleration as states of RTKLIB's filter."});
  v.value("interpolate_base", o.interpolate_base, {.doc = "The base's rate is lower than the rover's."});
  v.value("max_age_s", o.max_age, {.doc = "Oldest epoch of the base that is used.", .unit = "s", .min = 0, .max = 600});
  describe_base(v, g);
  v.value("antenna_file", g.antenna_file, {.doc = "ANTEX file of phase centres."});
  v.value("rover_antenna", o.rover_antenna, {.doc = "Type of the rover's antenna in the ANTEX file."});
  v.value("base_antenna", o.base_antenna, {.doc = "Type of the base's antenna."});
  v.value("rover_antenna_height_m", o.rover_antenna_height,
          {.doc = "Height of the rover's antenna reference point above the point that is wanted.", .unit = "m"});
  v.value("base_antenna_height_m", o.base_antenna_height,
          {.doc = "Height of the base's antenna reference point above its mark.", .unit = "m"});
  v.value(
      "disagreement_m", g.agreement.distance,
      {.doc = "Fixes whose forward and backward positions differ by more are doubted.", .unit = "m", .positive = true});
}

}  // namespace versine::app
