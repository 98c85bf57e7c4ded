// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/time.hpp"

/// What a catalogue knows of a journey: the summary that a unit leaves in the store, and what `merge` reads from it.
namespace versine::batch {

/// A point of a movement on a track. Between two of them distance is a cubic with the speeds at both ends.
struct Knot {
  Time time;
  double distance = 0.0;  ///< from the beginning of the map's line, m
  double speed = 0.0;     ///< m/s, positive towards the line's end
  double sigma = 0.0;     ///< of distance, m
};

/// A journey's stay on one line of the map, from entering to leaving it.
struct Pass {
  std::string track;         ///< line of the map
  double probability = 0.0;  ///< that the vehicle was on it, from all paths of the journey
  std::vector<Knot> knots;   ///< at least two, in order of time
};
/// When a pass was at a metre of its line, and how fast; nothing when it does not reach it.
[[nodiscard]] std::optional<Knot> knot_at(const Pass& pass, double distance);

struct PathEntry {
  double probability = 0.0;
  std::string tracks;  ///< "+A1;-X2": minus against the line's points
};

struct JourneyEntry {
  std::string recording;  ///< name inside its file; empty when the file is one recording
  int number = 1;         ///< in its recording
  TimeScale scale = TimeScale::recorder;
  Time from, to;
  double length = 0.0;           ///< m
  double entropy = 0.0;          ///< nat
  std::vector<PathEntry> paths;  ///< the most probable and the runner-up
  std::size_t fixes = 0, rejected = 0;
  double mean_nis = 0.0;  ///< normalised innovation squared of a fix over its 2 degrees of freedom; 1 when honest
  double sigma_rms = 0.0, sigma_max = 0.0;  ///< of distance along the track, m
  std::vector<Pass> passes;                 ///< in order of time
};

/// A recording, or a part of one, without a result.
struct FailureEntry {
  std::string recording;
  Error error;
};

struct Summary {
  std::vector<JourneyEntry> journeys;
  std::vector<FailureEntry> failures;
};

[[nodiscard]] std::string to_text(const Summary& summary);
[[nodiscard]] Expected<Summary> summary_from(const std::string& text);

}  // namespace versine::batch
