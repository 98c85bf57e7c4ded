// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "versine/georef/georeference.hpp"

namespace versine::georef {

/// A place on a journey's most probable path, in every term.
struct Position {
  std::size_t journey = 0;          ///< index in RecordingResult::journeys
  network::OrientedTrack track;     ///< piece of track of the map; index into Network::tracks
  std::size_t index_on_path = 0;    ///< of that piece
  double path_distance = 0.0;       ///< m
  double track_distance = 0.0;      ///< from the beginning of the map's own line (Track::line_id), m
  std::optional<double> mileage;    ///< m, where the map has it
  Eigen::Vector2d point{0.0, 0.0};  ///< map m relative to Network::origin
  double speed = 0.0, sigma = 0.0;  ///< m/s, m (of path_distance)
  double probability = 0.0;         ///< of the path
};

/// Finds positions for times that increase, in constant time each; a time before the last one asked for is found
/// again by bisection. Between grid steps distance, speed and sigma are linear, so that the distance is monotone within
/// a journey; with an IMU a step is 0.01 s and the chord of 1 m/s^2 lies within 0.02 mm of the curve.
/// Refers to map and result.
class PositionCursor {
 public:
  PositionCursor(const Map& map, const RecordingResult& result) : map_(map), result_(result) {}

  /// Distance and journey only; nothing outside the journeys. What streams at 20 kHz use.
  struct OnJourney {
    std::size_t journey = 0;
    double distance = 0.0, speed = 0.0, sigma = 0.0;
  };
  [[nodiscard]] std::optional<OnJourney> on_journey(Time time);
  /// The whole position; nothing outside the journeys.
  [[nodiscard]] std::optional<Position> at(Time time);
  /// Of the last time that was found.
  [[nodiscard]] std::size_t journey() const { return journey_; }
  /// A place on a journey's best path.
  [[nodiscard]] Position place(const OnJourney& j);

 private:
  [[nodiscard]] bool find(Time time);

  const Map& map_;
  const RecordingResult& result_;
  std::size_t journey_ = 0;
  std::size_t piece_ = 0, segment_ = 0, piece_journey_ = 0;  // where `place` was last
  double last_ = 0.0;
};

}  // namespace versine::georef
