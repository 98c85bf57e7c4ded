// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/georef/journeys.hpp"

namespace versine::georef {

/// One path that a journey may have taken, with the movement on it.
struct PathSolution {
  network::PathCoordinates coordinates;
  double probability = 0.0;            ///< posterior, among the hypotheses of the journey
  Evidence evidence;                   ///< what the probability is made of
  OnPath motion;                       ///< smoothed, on the journey's grid
  std::vector<FixResidual> residuals;  ///< innovations of the filter; weight 0: rejected
};

/// A choice at a facing switch of the most probable path.
struct SwitchDecision {
  network::OrientedTrack from, to;
  double probability = 0.0;  ///< that this leg was taken, given that the switch was passed this way
  Time time;                 ///< of passing it
};

/// Where another path leaves the most probable one, and comes back (or does not, at the journey's ends).
struct AmbiguousStretch {
  Time from, to;
  double begin = 0.0, end = 0.0;     ///< on the most probable path, m
  network::Path taken, alternative;  ///< tracks that only one of both has
  std::vector<std::size_t> paths;    ///< indices of those that take the alternative
  double probability = 0.0;          ///< of the alternative
  Evidence evidence;                 ///< most probable path minus the best of `paths`: what decided
};

struct JourneyResult {
  Time start;
  double grid = 0.0;  ///< s between the steps of OnPath
  std::size_t steps = 0;
  std::vector<PathSolution> paths;  ///< most probable first; probabilities sum to 1
  std::vector<SwitchDecision> switches;
  std::vector<AmbiguousStretch> ambiguous;  ///< in order of time
  double entropy = 0.0;                     ///< of the paths' probabilities, nat
  bool starts_standing = false, ends_standing = false;

  [[nodiscard]] Time end() const {
    return start + Duration::from_seconds(grid * static_cast<double>(steps == 0 ? 0 : steps - 1));
  }
};

struct RecordingResult {
  std::string name;
  TimeScale scale = TimeScale::recorder;
  std::vector<JourneyResult> journeys;
  Series<Fix> fixes;  ///< as used: in order, without what was removed; FixResidual::fix counts them
  RunRecord record;
};

/// The whole of Roth 2018: journeys, path hypotheses, filter and smoother on each, posterior. Fails when nothing of
/// the recording lies on the map (and says whether swapped coordinates would). Pure. Many threads may share a map when
/// each passes a projection of its own, a copy of the map's.
[[nodiscard]] Expected<RecordingResult> georeference(const Map& map, Recording recording, const Options& options,
                                                     std::span<const Constraint> constraints = {},
                                                     const geodesy::Projection* projection = nullptr);

/// Whether each constraint has a time span and a track; and whether the map has its tracks.
[[nodiscard]] Expected<void> check(std::span<const Constraint> constraints);
[[nodiscard]] Expected<void> check(const Map& map, std::span<const Constraint> constraints);

/// Where the vehicle was at a time.
struct Stamp {
  bool valid = false;  ///< the time is within a journey
  std::size_t journey = 0;
  double distance = 0.0;     ///< on the most probable path, m
  double speed = 0.0;        ///< m/s
  double sigma = 0.0;        ///< of distance, m
  double probability = 0.0;  ///< of the path
};
/// Linear between grid steps, monotone within a journey.
[[nodiscard]] Stamp stamp(const RecordingResult& result, Time time);

}  // namespace versine::georef
