// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/georef/on_path.hpp"
#include "versine/georef/path_inference.hpp"
#include "versine/georef/recording.hpp"

namespace versine::georef {

/// Time order for every series: samples that repeat a time, run backwards or are no numbers are removed and counted;
/// IMU samples that arrived late in a batch are spread over the gap before them.
void put_in_order(Recording& recording);

/// Removes fixes of a type that is not used (dead-reckoned ones drift by hundreds of metres in a tunnel).
void drop_unused_fixes(Recording& recording, const GnssModel& model);

/// Sets Fix::place, map m relative to Network::origin; the one use of a projection. Fixes outside the projection's area
/// are removed and counted.
void place_on_map(Recording& recording, const network::Network& network, const geodesy::Projection& projection);

/// The vehicle stood, as the fixes say.
struct Standstill {
  Time from, until;
};

/// A movement in one direction, from standstill to standstill (or what the recording has of it): fixes [first, last].
struct JourneySpan {
  std::size_t first = 0, last = 0;
  bool starts_standing = false, ends_standing = false;
  bool goes_on = false;           ///< begins where the journey before it ended: nothing moved in between
  std::vector<Standstill> stops;  ///< at both ends and in between, in order of time
};
/// Splits by speed, and joins again where the vehicle went on in the same direction (unless every_stop). Standstill of
/// up to 20 s is kept at both ends, for the known zero speed and the end positions. REQUIRES put_in_order and
/// place_on_map, as all below.
[[nodiscard]] std::vector<JourneySpan> find_journeys(const Recording& recording, const JourneyOptions& options,
                                                     RunRecord& record);

/// Fixes farther than `radius` from any track cannot be right by less: they are given that large a sigma, so that they
/// serve to find the path only. Returns how many.
std::size_t mark_astray(const Map& map, Recording& recording, double radius);

/// Standard deviation used for a fix, m: the receiver's own, enlarged, or by its type.
[[nodiscard]] double fix_sigma(const Fix& fix, const GnssModel& model);

/// Fixes of a journey for the coarse search.
[[nodiscard]] std::vector<Knot> make_knots(const Recording& recording, const JourneySpan& span, const Options& options);

/// Measurements of [from, to] on the time grid.
[[nodiscard]] Epochs make_epochs(const Recording& recording, const JourneySpan& span, Time from, Time to,
                                 const Options& options);

}  // namespace versine::georef
