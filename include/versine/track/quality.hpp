// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/track/geometry.hpp"
#include "versine/track/limits.hpp"

namespace versine::track {

/// A stretch over a limit, merged around its peak.
struct Exceedance {
  std::string column;
  std::string level;                          ///< the severest level that the peak exceeds
  int severity = 0;                           ///< index of the level
  double start = 0.0, end = 0.0, peak = 0.0;  ///< continuous mileage, m
  double value = 0.0;                         ///< at the peak, SI
  double sigma = 0.0;                         ///< at the peak; NaN when unknown
  double limit = 0.0;                         ///< that is exceeded, SI
  /// That the true value is over the limit: normal distribution around the value; NaN without sigma.
  double probability = 0.0;
  std::size_t index = 0;  ///< of the peak in the geometry
};

/// Statistics of one section of 200 m.
struct Section {
  double start = 0.0, end = 0.0;  ///< continuous mileage, m
  /// By column, SI. Cross level and twist without cant and its ramps: less the design's, or where there is none freed
  /// of wavelengths beyond 70 m.
  std::vector<std::pair<std::string, double>> sigma;
  double tqi = 0.0;   ///< sum of sigmas, m; NaN when a part is missing
  double cosd = 0.0;  ///< combined standard deviation, m; NaN when a part is missing
  std::vector<std::pair<std::string, std::string>> classes;  ///< by column
  std::vector<std::string> over;  ///< "level of column" for section limits and TQI that are exceeded
};

struct Quality {
  std::string profile, source;
  double speed = 0.0;                   ///< m/s
  std::vector<std::string> levels;      ///< of the profile, mildest first
  std::vector<Limit> applied;           ///< those of this speed, `column` being the geometry's own; mildest first
  double tqi_limit = 0.0;               ///< of a section's TQI, m; 0: none
  std::vector<Exceedance> exceedances;  ///< by mileage
  std::vector<Section> sections;
  std::vector<std::string> unchecked;  ///< limits whose column the geometry does not have
};

/// Compares geometry with the limits for a speed (m/s). Stretches of one column and one sign that are less than
/// `merge` apart are one exceedance. Fails when the profile has no class for the speed.
[[nodiscard]] Expected<Quality> assess(const Geometry& geometry, const LimitProfile& profile, double speed,
                                       double merge = 2.0);

}  // namespace versine::track
