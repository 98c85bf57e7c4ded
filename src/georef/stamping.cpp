// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/stamping.hpp"

#include <algorithm>

namespace versine::georef {

bool PositionCursor::find(Time time) {
  const auto& js = result_.journeys;
  const auto covers = [&](std::size_t i) { return i < js.size() && !(time < js[i].start) && !(js[i].end() < time); };
  if (covers(journey_)) return true;
  if (covers(journey_ + 1)) {
    ++journey_;
    return true;
  }
  const auto it = std::upper_bound(js.begin(), js.end(), time, [](Time t, const auto& j) { return t < j.start; });
  if (it == js.begin()) return false;
  const auto index = static_cast<std::size_t>(it - js.begin()) - 1;
  if (!covers(index)) return false;
  journey_ = index;
  return true;
}

std::optional<PositionCursor::OnJourney> PositionCursor::on_journey(Time time) {
  if (!find(time)) return std::nullopt;
  const JourneyResult& j = result_.journeys[journey_];
  if (j.steps == 0 || j.paths.empty()) return std::nullopt;
  const double x = (time - j.start).seconds() / j.grid;
  const auto k = std::min(static_cast<std::size_t>(std::max(x, 0.0)), j.steps - 1);
  const std::size_t next = std::min(k + 1, j.steps - 1);
  const double u = std::clamp(x - static_cast<double>(k), 0.0, 1.0);
  const auto& m = j.paths.front().motion;
  const auto mix = [u](double a, double b) { return a + u * (b - a); };
  return OnJourney{journey_, mix(m.distance[k], m.distance[next]), mix(m.speed[k], m.speed[next]),
                   mix(m.sigma_distance[k], m.sigma_distance[next])};
}

Position PositionCursor::place(const OnJourney& j) {
  const PathSolution& best = result_.journeys[j.journey].paths.front();
  const auto& starts = best.coordinates.starts();
  if (piece_journey_ != j.journey || j.distance < last_) piece_journey_ = j.journey, piece_ = 0, segment_ = 0;
  last_ = j.distance;
  const std::size_t pieces = best.coordinates.path().size();
  while (piece_ + 1 < pieces && starts[piece_ + 1] <= j.distance) ++piece_;
  Position p;
  p.journey = j.journey;
  p.index_on_path = piece_;
  p.track = best.coordinates.path()[piece_];
  p.path_distance = j.distance;
  const auto& track = map_.network.tracks[p.track.track];
  const double length = track.line.length();
  const double into = std::clamp(j.distance - starts[piece_], 0.0, length);
  const double from_begin = p.track.reversed ? length - into : into;
  p.track_distance = track.line_offset + from_begin;
  if (track.mileage_begin && track.mileage_end) {
    p.mileage = *track.mileage_begin + (*track.mileage_end - *track.mileage_begin) * from_begin / length;
  }
  p.point = best.coordinates.position(j.distance, segment_);
  p.speed = j.speed, p.sigma = j.sigma;
  p.probability = best.probability;
  return p;
}

std::optional<Position> PositionCursor::at(Time time) {
  const auto j = on_journey(time);
  if (!j) return std::nullopt;
  return place(*j);
}

}  // namespace versine::georef
