// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/georeference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posterior.hpp"
#include "versine/core/parallel.hpp"

namespace versine::georef {

namespace {

/// Leaves out tracks at both ends that the vehicle never was on.
void trim(const network::Network& network, PathSolution& p) {
  const auto& starts = p.coordinates.starts();
  std::size_t first = 0, last = p.coordinates.path().size() - 1;
  const auto& m = p.motion;
  // Where no good fix tells the end's distance, the coarse search knows better than the filter.
  const auto surely = [](float sigma) { return sigma < 30.0F ? 2.0 * static_cast<double>(sigma) : 1e9; };
  const double begins = m.distance.front() - surely(m.sigma_distance.front());
  const double ends = m.distance.back() + surely(m.sigma_distance.back());
  while (first < last && starts[first + 1] <= begins) ++first;
  while (last > first && starts[last] >= ends) --last;
  if (first == 0 && last + 1 == p.coordinates.path().size()) return;
  const double offset = starts[first];
  for (double& d : p.motion.distance) d -= offset;
  const auto& whole = p.coordinates.path();
  const auto from = whole.begin() + static_cast<std::ptrdiff_t>(first),
             to = whole.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  p.coordinates = network::PathCoordinates(network, network::Path(from, to));
}

/// Two passes on a path: the second, after the filter's `first`, weighs each fix by what the whole journey says of it.
void solve_on_path(const Map& map, const Epochs& epochs, const Options& options, const Filtered& first,
                   PathSolution& p) {
  const auto rough = smooth(epochs, first);
  const auto weights = smoothed_weights(p.coordinates, epochs, options, first, rough);
  auto second = filter_on_path(p.coordinates, epochs, options, weights);
  p.motion = densify(epochs, smooth(epochs, second));
  p.residuals = std::move(second.residuals);
  trim(map.network, p);
}

JourneyResult solve(const Map& map, const Epochs& epochs, const JourneySpan& span, std::vector<Hypothesis> hypotheses,
                    const Options& options) {
  JourneyResult j;
  j.start = epochs.start;
  j.grid = epochs.grid;
  j.steps = static_cast<std::size_t>(epochs.epochs.back().step) + 1;
  j.starts_standing = span.starts_standing;
  j.ends_standing = span.ends_standing;
  const double least = std::log(options.smallest_probability);
  std::vector<Filtered> filtered(hypotheses.size());
  j.paths.resize(hypotheses.size());
  parallel_for(hypotheses.size(), options.threads, [&](std::size_t i) {
    PathSolution& p = j.paths[i];
    p.coordinates = network::PathCoordinates(map.network, std::move(hypotheses[i].path));
    filtered[i] = filter_on_path(p.coordinates, epochs, options);
    p.evidence = filtered[i].evidence;
    p.evidence.route = hypotheses[i].prior - hypotheses[i].astray;
  });
  double best = -INFINITY;
  for (const auto& p : j.paths) best = std::max(best, p.evidence.total());
  parallel_for(filtered.size(), options.threads, [&](std::size_t i) {
    if (!(j.paths[i].evidence.total() < best + least)) solve_on_path(map, epochs, options, filtered[i], j.paths[i]);
    filtered[i] = {};
  });
  set_posterior(j.paths);
  std::erase_if(j.paths, [&](const auto& p) { return p.probability < options.smallest_probability; });
  double sum = 0.0;
  for (auto& p : j.paths) sum += p.probability;
  for (auto& p : j.paths) p.probability /= sum;
  merge_equal(j.paths);
  for (const auto& p : j.paths) j.entropy -= p.probability > 0.0 ? p.probability * std::log(p.probability) : 0.0;
  find_switches(map, j);
  find_ambiguous(j);
  return j;
}

/// Where a journey may have ended: the start of the next.
std::vector<StartPlace> end_places(const JourneyResult& j) {
  std::vector<StartPlace> out;
  for (const auto& p : j.paths) {
    const auto at = p.coordinates.place(p.motion.distance.back());
    out.push_back({at.track.track, at.distance, static_cast<double>(p.motion.sigma_distance.back()), p.probability});
  }
  return out;
}

Error outside(const Map& map, const Recording& r, const geodesy::Projection& projection) {
  Error e{.file = r.name,
          .field = "gnss",
          .expected = fmt::format("positions on the map '{}'", map.network.file),
          .advice = "load the map of the place where the recording was made"};
  const auto& f = r.gnss[r.gnss.size() / 2].position;
  e.found = fmt::format("positions around {:.5f}, {:.5f} deg, where the map has no track",
                        f.latitude * 57.29577951308232, f.longitude * 57.29577951308232);
  const auto exchanged = projection.forward({f.longitude, f.latitude, 0.0});
  const Eigen::Vector2d swapped = Eigen::Vector2d(exchanged.easting, exchanged.northing) - map.network.origin;
  if (swapped.allFinite() && !map.index.near(swapped, 500.0).empty()) {
    e.found += "; with latitude and longitude exchanged they lie on it";
    e.advice = "exchange the two columns";
  }
  return e;
}

/// Journeys of a recording, one span after the other.
class Solver {
 public:
  Solver(const Map& map, Recording& recording, const Options& options, std::vector<Constraint> constraints,
         RecordingResult& result)
      : map_(map), r_(recording), options_(options), constraints_(std::move(constraints)), result_(result) {}

  void add(const JourneySpan& span) {
    const auto knots = make_knots(r_, span, options_);
    const auto start = span.goes_on ? ended_ : std::vector<StartPlace>{};
    ended_.clear();
    const auto stretches = infer_paths(map_, knots, options_.inference, constraints_, start);
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const auto& stretch = stretches[s];
      const Time from =
          s == 0 ? std::max(knots[stretch.first].time, r_.gnss[span.first].time) : knots[stretch.first].time;
      const Time to = knots[stretch.last].time;
      if (s > 0) note("no way on the map", knots[stretches[s - 1].last].time, from, 1, Finding::Action::split);
      if ((to - from).seconds() < options_.journeys.shortest) continue;
      JourneySpan part = span;
      part.starts_standing = span.starts_standing && s == 0;
      part.ends_standing = span.ends_standing && s + 1 == stretches.size();
      solve_part(part, from, to, stretch);
      if (part.ends_standing) ended_ = end_places(result_.journeys.back());
    }
    if (stretches.empty()) {
      note("off the map", r_.gnss[span.first].time, r_.gnss[span.last].time, span.last - span.first + 1,
           Finding::Action::removed);
    }
  }

 private:
  void solve_part(const JourneySpan& part, Time from, Time to, const Stretch& stretch) {
    const auto epochs = make_epochs(r_, part, from, to, options_);
    auto journey = solve(map_, epochs, part, stretch.hypotheses, options_);
    for (const auto& f : journey.paths.front().residuals) {
      if (f.weight > 0.0F) continue;
      result_.record.rejections.push_back({"gnss", r_.gnss[f.fix].time, "innovation",
                                           std::sqrt(static_cast<double>(f.nis)), std::sqrt(options_.gnss.gate)});
    }
    result_.journeys.push_back(std::move(journey));
  }

  void note(const char* kind, Time from, Time to, std::size_t count, Finding::Action action) {
    const bool constrained = std::any_of(constraints_.begin(), constraints_.end(),
                                         [&](const Constraint& c) { return c.from <= to && from <= c.to; });
    result_.record.findings.push_back(
        {"gnss", kind, from, to, count, action,
         constrained ? "a constraint leaves no way on the map" : "a hole in the map, or fixes far from any track"});
  }

  const Map& map_;
  const Recording& r_;
  const Options& options_;
  std::vector<Constraint> constraints_;
  RecordingResult& result_;
  std::vector<StartPlace> ended_;
};

std::vector<Constraint> of_recording(std::span<const Constraint> all, const std::string& name) {
  std::vector<Constraint> out;
  for (const auto& c : all) {
    if (c.recording.empty() || c.recording == name || name.ends_with("/" + c.recording)) out.push_back(c);
  }
  return out;
}

}  // namespace

Expected<RecordingResult> georeference(const Map& map, Recording recording, const Options& options,
                                       std::span<const Constraint> constraints, const geodesy::Projection* own) {
  const geodesy::Projection& projection = own != nullptr ? *own : map.network.projection;
  put_in_order(recording);
  drop_unused_fixes(recording, options.gnss);
  place_on_map(recording, map.network, projection);
  RecordingResult result{recording.name, recording.gnss.scale, {}, {}, std::move(recording.record)};
  if (recording.gnss.size() < 3) {
    return fail({.file = recording.name,
                 .field = "gnss",
                 .found = fmt::format("{} usable fixes", recording.gnss.size()),
                 .expected = "a recording with GNSS positions",
                 .advice = result.record.findings.empty()
                               ? "the file has hardly any"
                               : fmt::format("{} were removed: {}", result.record.findings.front().count,
                                             result.record.findings.front().kind)});
  }
  if (const auto n = mark_astray(map, recording, options.inference.radius); n > 0) {
    result.record.findings.push_back({"gnss", "far from any track", recording.gnss.front().time,
                                      recording.gnss.back().time, n, Finding::Action::noted,
                                      "used to find the path only"});
  }
  const auto spans = find_journeys(recording, options.journeys, result.record);
  Solver solver(map, recording, options, of_recording(constraints, recording.name), result);
  for (const auto& span : spans) solver.add(span);
  if (result.journeys.empty() && !spans.empty()) return tl::unexpected(outside(map, recording, projection));
  result.fixes = std::move(recording.gnss);
  return result;
}

Expected<void> check(std::span<const Constraint> constraints) {
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const auto& c = constraints[i];
    const std::string field = fmt::format("constraint[{}].", i);
    if (!(c.from < c.to)) {
      return fail({.field = field + "to_s",
                   .found = fmt::format("{} s, not after from_s = {} s", c.to.seconds(), c.from.seconds()),
                   .expected = "a time span",
                   .advice = "exchange both, or mend one"});
    }
    if (c.tracks.empty()) {
      return fail({.field = field + "tracks",
                   .found = "none",
                   .expected = "the identifiers of at least one track",
                   .advice = "name them, or take the constraint out"});
    }
  }
  return {};
}

Expected<void> check(const Map& map, std::span<const Constraint> constraints) {
  if (auto good = check(constraints); !good) return good;
  const auto& tracks = map.network.tracks;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    for (const auto& id : constraints[i].tracks) {
      if (std::any_of(tracks.begin(), tracks.end(), [&](const auto& t) { return t.id == id || t.line_id == id; })) {
        continue;
      }
      return fail({.field = fmt::format("constraint[{}].tracks", i),
                   .found = fmt::format("'{}', which is not on the map", id),
                   .expected = "identifiers of tracks or lines of the map",
                   .advice = "take them from georef.json or network.geojson of the result"});
    }
  }
  return {};
}

Stamp stamp(const RecordingResult& result, Time time) {
  const auto it = std::upper_bound(result.journeys.begin(), result.journeys.end(), time,
                                   [](Time t, const JourneyResult& j) { return t < j.start; });
  if (it == result.journeys.begin()) return {};
  const JourneyResult& j = *std::prev(it);
  const double x = (time - j.start).seconds() / j.grid;
  if (j.steps == 0 || !(x <= static_cast<double>(j.steps - 1))) return {};
  const auto k = std::min(static_cast<std::size_t>(x), j.steps - 1);
  const std::size_t next = std::min(k + 1, j.steps - 1);
  const double u = x - static_cast<double>(k);
  const auto mix = [u](double a, double b) { return a + u * (b - a); };
  const auto& m = j.paths.front().motion;
  return {true,
          static_cast<std::size_t>(std::prev(it) - result.journeys.begin()),
          mix(m.distance[k], m.distance[next]),
          mix(m.speed[k], m.speed[next]),
          mix(m.sigma_distance[k], m.sigma_distance[next]),
          j.paths.front().probability};
}

}  // namespace versine::georef
