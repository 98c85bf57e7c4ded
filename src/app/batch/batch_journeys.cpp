// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/app/batch.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/georef/stamping.hpp"

namespace versine::app {

namespace {
using batch::Knot;

/// Pieces [first, last] of a path that are one line of the map, run through in one direction.
struct Stay {
  std::size_t first = 0, last = 0;
};

class JourneyTracer {
 public:
  JourneyTracer(const georef::Map& map, const georef::JourneyResult& j)
      : map_(map), j_(j), best_(j.paths.front()), d_(best_.motion.distance) {}

  std::vector<batch::Pass> passes() const {
    std::vector<batch::Pass> out;
    const auto& path = best_.coordinates.path();
    for (std::size_t i = 0; i < path.size();) {
      Stay stay{i, i};
      while (stay.last + 1 < path.size() && goes_on(path[stay.last], path[stay.last + 1])) ++stay.last;
      if (auto p = pass(stay); p.knots.size() > 1) out.push_back(std::move(p));
      i = stay.last + 1;
    }
    return out;
  }

 private:
  [[nodiscard]] const network::Track& track(network::OrientedTrack t) const { return map_.network.tracks[t.track]; }

  [[nodiscard]] bool goes_on(network::OrientedTrack a, network::OrientedTrack b) const {
    const auto &s = track(a), &t = track(b);
    const double gap = a.reversed ? s.line_offset - (t.line_offset + t.line.length())
                                  : t.line_offset - (s.line_offset + s.line.length());
    return s.line_id == t.line_id && a.reversed == b.reversed && std::abs(gap) < 0.01;
  }

  [[nodiscard]] batch::Pass pass(const Stay& stay) const {
    const auto& starts = best_.coordinates.starts();
    const double from = std::max(starts[stay.first], d_.front()), to = std::min(starts[stay.last + 1], d_.back());
    batch::Pass p{track(best_.coordinates.path()[stay.first]).line_id, probability(stay), {}};
    // The ends of a journey belong to its first and last stay, however long the vehicle stood there.
    const double begin = stay.first == 0 || from <= d_.front() ? 0.0 : step_at(from);
    const bool ends = stay.last + 1 == best_.coordinates.path().size() || to >= d_.back();
    const double end = ends ? static_cast<double>(j_.steps - 1) : step_at(to);
    if (!(end > begin)) return p;
    p.knots.push_back(knot(stay, begin));
    for (double at = begin; at < end;) p.knots.push_back(knot(stay, at = next(at, end)));
    return p;
  }

  /// Of having been there: over all paths, the piece that the fewest share.
  [[nodiscard]] double probability(const Stay& stay) const {
    double least = 1.0;
    for (std::size_t i = stay.first; i <= stay.last; ++i) {
      double sum = 0.0;
      for (const auto& p : j_.paths) {
        const auto& path = p.coordinates.path();
        if (std::find(path.begin(), path.end(), best_.coordinates.path()[i]) != path.end()) sum += p.probability;
      }
      least = std::min(least, sum);
    }
    return least;
  }

  /// Grid step, with a fraction, at which a distance is reached.
  [[nodiscard]] double step_at(double distance) const {
    const auto it = std::lower_bound(d_.begin(), d_.end(), distance);
    if (it == d_.begin()) return 0.0;
    const auto k = static_cast<std::size_t>(it - d_.begin());
    if (k == d_.size()) return static_cast<double>(j_.steps - 1);
    return static_cast<double>(k - 1) + (distance - d_[k - 1]) / (d_[k] - d_[k - 1]);
  }

  template <class List>
  [[nodiscard]] double value(const List& list, double step) const {
    const auto k = std::min(static_cast<std::size_t>(step), list.size() - 1);
    const std::size_t n = std::min(k + 1, list.size() - 1);
    const double u = step - static_cast<double>(k);
    return (1.0 - u) * list[k] + u * list[n];
  }

  [[nodiscard]] Knot knot(const Stay& stay, double step) const {
    const auto& t = track(best_.coordinates.path()[stay.first]);
    const bool reversed = best_.coordinates.path()[stay.first].reversed;
    const double into = value(d_, step) - best_.coordinates.starts()[stay.first];
    const double sign = reversed ? -1.0 : 1.0;
    return {j_.start + Duration::from_seconds(j_.grid * step),
            t.line_offset + (reversed ? t.line.length() : 0.0) + sign * into, sign * value(best_.motion.speed, step),
            value(best_.motion.sigma_distance, step)};
  }

  /// The farthest step to which one cubic stays within 5 cm of the movement.
  [[nodiscard]] double next(double at, double end) const {
    double farthest = std::min(end, at + 1.0 / j_.grid);
    for (double span = 64.0; span > 1.0; span *= 0.5) {
      const double to = std::min(end, at + span / j_.grid);
      if (!follows(at, to)) continue;
      farthest = to;
      break;
    }
    return farthest;
  }

  [[nodiscard]] bool follows(double from, double to) const {
    const double span = j_.grid * (to - from);
    const double a = value(d_, from), b = value(d_, to), u0 = span * value(best_.motion.speed, from),
                 u1 = span * value(best_.motion.speed, to);
    const int checks = std::max(4, static_cast<int>(2.0 * span));
    for (int i = 1; i < checks; ++i) {
      const double u = static_cast<double>(i) / checks, v = 1.0 - u;
      const double d = v * v * (1.0 + 2.0 * u) * a + u * u * (3.0 - 2.0 * u) * b + u * v * (v * u0 - u * u1);
      if (std::abs(d - value(d_, from + u * (to - from))) > 0.05) return false;
    }
    return true;
  }

  const georef::Map& map_;
  const georef::JourneyResult& j_;
  const georef::PathSolution& best_;
  const std::vector<double>& d_;
};

std::string tracks_text(const georef::Map& map, const network::Path& path) {
  std::string text;
  for (const auto& t : path) {
    text += fmt::format("{}{}{}", text.empty() ? "" : ";", t.reversed ? "-" : "+", map.network.tracks[t.track].id);
  }
  return text;
}

void add_quality(const georef::PathSolution& best, batch::JourneyEntry& e) {
  double nis = 0.0, square = 0.0;
  for (const auto& r : best.residuals) {
    ++e.fixes;
    e.rejected += r.weight > 0.0F ? 0 : 1;
    nis += r.weight > 0.0F ? r.nis : 0.0;
  }
  if (e.fixes > e.rejected) e.mean_nis = nis / 2.0 / static_cast<double>(e.fixes - e.rejected);
  for (const double s : best.motion.sigma_distance) {
    square += s * s;
    e.sigma_max = std::max(e.sigma_max, s);
  }
  e.sigma_rms = std::sqrt(square / static_cast<double>(best.motion.sigma_distance.size()));
}
}  // namespace

std::vector<batch::JourneyEntry> journey_entries(const georef::Map& map, const georef::RecordingResult& result) {
  std::vector<batch::JourneyEntry> out;
  for (const auto& j : result.journeys) {
    if (j.paths.empty() || j.steps == 0) continue;
    const auto& best = j.paths.front();
    batch::JourneyEntry e;
    e.recording = result.name;
    e.number = static_cast<int>(&j - result.journeys.data()) + 1;
    e.scale = result.scale;
    e.from = j.start, e.to = j.end();
    e.length = best.motion.distance.back() - best.motion.distance.front();
    e.entropy = j.entropy;
    for (std::size_t p = 0; p < std::min<std::size_t>(2, j.paths.size()); ++p) {
      e.paths.push_back({j.paths[p].probability, tracks_text(map, j.paths[p].coordinates.path())});
    }
    add_quality(best, e);
    e.passes = JourneyTracer(map, j).passes();
    out.push_back(std::move(e));
  }
  return out;
}

std::string positions_table(const georef::Map& map, const std::vector<const georef::RecordingResult*>& results,
                            double interval) {
  fmt::memory_buffer text;
  const auto to = std::back_inserter(text);
  fmt::format_to(to,
                 "recording,journey,time_s,latitude_deg,longitude_deg,track,track_distance_m,mileage_m,path_distance_m,"
                 "speed_mps,sigma_m,probability\n");
  for (const auto* result : results) {
    georef::PositionCursor cursor(map, *result);
    for (const auto& j : result->journeys) {
      const auto every = std::max<std::size_t>(1, static_cast<std::size_t>(std::round(interval / j.grid)));
      for (std::size_t i = 0; i < j.steps; i += every) {
        const Time t = j.start + Duration::from_seconds(j.grid * static_cast<double>(i));
        const auto p = cursor.at(t);
        if (!p) continue;
        const auto g = map.network.to_geodetic(p->point);
        fmt::format_to(to, "{},{},{},{:.9f},{:.9f},{},{:.3f},{},{:.3f},{:.3f},{:.3f},{:.4f}\n", result->name,
                       p->journey + 1, seconds_text(t), g.latitude / units::deg, g.longitude / units::deg,
                       map.network.tracks[p->track.track].line_id, p->track_distance,
                       p->mileage ? fmt::format("{:.3f}", *p->mileage) : "", p->path_distance, p->speed, p->sigma,
                       p->probability);
      }
    }
  }
  return fmt::to_string(text);
}

}  // namespace versine::app
