// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/units.hpp"
#include "versine/stationing/readings.hpp"

namespace versine::stationing {

/// What a total station can do, and what is still to be corrected in its readings.
struct Instrument {
  double angle_sigma = 0.5 * units::arcsec;  ///< of a direction or zenith angle in both faces once (ISO 17123-3), rad
  double distance_sigma = 0.6 * units::mm;   ///< of a distance (ISO 17123-4), m; repeating the same line does not
                                             ///< improve it, since its error stays the same
  double distance_sigma_ppm = 1.0;           ///< part that grows with the distance
  double target_sigma = 0.1 * units::mm;     ///< of the prism about its point, each direction, m
  double collimation = 0.0;                  ///< from a calibration, for targets without face II, rad
  double index_error = 0.0;                  ///< as before, of the vertical circle, rad
  bool one_face = false;                     ///< face I alone is meant so: the instrument corrects both itself
  double scale_ppm = 0.0;                    ///< known error of the distance's scale
  double wavelength = 0.658;                 ///< of the distance meter, um
  Atmosphere reference_air;                  ///< that the instrument computes for
  double refraction = 0.13;                  ///< coefficient k
};

/// The readings of one target, reduced to one direction, zenith angle (face I) and distance.
struct Target {
  std::string point;
  double direction = 0.0;  ///< rad, circle of the first set
  double zenith = 0.0;     ///< rad, corrected for index error and refraction
  double distance = 0.0;   ///< m, corrected for prism, air and scale; NaN: none
  double target_height = 0.0;
  double direction_sigma = 0.0, zenith_sigma = 0.0, distance_sigma = 0.0;  ///< from the instrument, rad, rad, m
  /// Standard deviations among the sets (of one set), rad, rad, m; NaN with one set.
  double direction_spread = 0.0, zenith_spread = 0.0, distance_spread = 0.0;
  std::size_t readings = 0;
  std::size_t line = 0;  ///< of the first reading
};

/// A station's readings after reduction of faces and sets.
struct ReducedStation {
  std::string name;
  std::string mark;  ///< number of the point it stands over; empty: none
  double instrument_height = 0.0;
  std::optional<Time> from, to;
  std::optional<FeltUp> felt_up;
  std::vector<Target> targets;        ///< in the order in which the points first occur
  std::optional<double> collimation;  ///< found from two faces, rad
  std::optional<double> index_error;  ///< rad
  std::size_t sets = 0;
  std::size_t dropped = 0;  ///< readings left out because they contradict the other sets
  std::vector<std::string> warnings;
};

/// Means of faces and sets. Both faces: collimation and index error cancel, and their values are found on the way. One
/// face: corrected with what the station's other targets show, otherwise with the calibration's values, and warned of.
/// Sets whose circle was turned in between are brought to the first one by a least-squares station adjustment. With
/// three sets or more a reading that lies further than six sigmas from the median of its target is left out. Fails when
/// the two faces show that angles were read in another unit than told (gon as degrees and the like), when a value is
/// not a number, or when there is nothing to reduce.
[[nodiscard]] Expected<ReducedStation> reduce(const Stationing& stationing, const Instrument& instrument);

}  // namespace versine::stationing
