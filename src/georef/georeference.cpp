// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/georeference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace versine::georef {

namespace {

/// Probabilities from log-likelihoods and priors.
void set_posterior(std::vector<PathSolution>& paths) {
  double best = -INFINITY, sum = 0.0;
  for (const auto& p : paths) best = std::max(best, p.log_likelihood + p.log_prior);
  for (auto& p : paths) sum += p.probability = std::exp(p.log_likelihood + p.log_prior - best);
  for (auto& p : paths) p.probability /= sum;
  std::stable_sort(paths.begin(), paths.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

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

void merge_equal(std::vector<PathSolution>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = i + 1; j < paths.size();) {
      if (paths[j].coordinates.path() == paths[i].coordinates.path()) {
        paths[i].probability += paths[j].probability;
        paths.erase(paths.begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        ++j;
      }
    }
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

bool has_step(const network::Path& path, network::OrientedTrack from, const network::OrientedTrack* to) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (path[i] == from && (to == nullptr || path[i + 1] == *to)) return true;
  }
  return false;
}

Time time_of(const JourneyResult& j, std::size_t step) {
  return j.start + Duration::from_seconds(j.grid * static_cast<double>(step));
}

void find_switches(const Map& map, JourneyResult& j) {
  const auto& best = j.paths.front();
  const auto& path = best.coordinates.path();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (map.graph.successors(path[i]).size() < 2) continue;
    double passed = 0.0, same = 0.0;
    for (const auto& p : j.paths) {
      if (has_step(p.coordinates.path(), path[i], nullptr)) passed += p.probability;
      if (has_step(p.coordinates.path(), path[i], &path[i + 1])) same += p.probability;
    }
    const auto& d = best.motion.distance;
    const auto at = std::lower_bound(d.begin(), d.end(), best.coordinates.starts()[i + 1]) - d.begin();
    j.switches.push_back(
        {path[i], path[i + 1], same / passed, time_of(j, std::min(static_cast<std::size_t>(at), j.steps - 1))});
  }
}

/// Two passes on a path: the second weighs each fix by what the whole journey says of it.
void solve_on_path(const Map& map, const Epochs& epochs, const Options& options, PathSolution& p) {
  const auto first = filter_on_path(p.coordinates, epochs, options);
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
  for (auto& h : hypotheses) {
    PathSolution p;
    p.coordinates = network::PathCoordinates(map.network, std::move(h.path));
    p.log_prior = h.prior - h.astray;
    p.log_likelihood = filter_on_path(p.coordinates, epochs, options).log_likelihood;
    j.paths.push_back(std::move(p));
  }
  set_posterior(j.paths);
  std::erase_if(j.paths, [&](const auto& p) { return p.probability < options.smallest_probability; });
  double sum = 0.0;
  for (auto& p : j.paths) {
    solve_on_path(map, epochs, options, p);
    sum += p.probability;
  }
  for (auto& p : j.paths) p.probability /= sum;
  merge_equal(j.paths);
  for (const auto& p : j.paths) j.entropy -= p.probability > 0.0 ? p.probability * std::log(p.probability) : 0.0;
  find_switches(map, j);
  return j;
}

Error outside(const Map& map, const Recording& r) {
  Error e{.file = r.name,
          .field = "gnss",
          .expected = fmt::format("positions on the map '{}'", map.network.file),
          .advice = "load the map of the place where the recording was made"};
  const auto& f = r.gnss[r.gnss.size() / 2].position;
  e.found = fmt::format("positions around {:.5f}, {:.5f} deg, where the map has no track",
                        f.latitude * 57.29577951308232, f.longitude * 57.29577951308232);
  const Eigen::Vector2d swapped = map.network.to_map({f.longitude, f.latitude, 0.0});
  if (swapped.allFinite() && !map.index.near(swapped, 500.0).empty()) {
    e.found += "; with latitude and longitude exchanged they lie on it";
    e.advice = "exchange the two columns";
  }
  return e;
}

}  // namespace

Expected<RecordingResult> georeference(const Map& map, Recording recording, const Options& options,
                                       std::span<const Constraint> constraints) {
  put_in_order(recording);
  drop_unused_fixes(recording, options.gnss);
  RecordingResult result{recording.name, recording.gnss.scale, {}, std::move(recording.record)};
  if (recording.gnss.size() < 3) {
    return fail({.file = recording.name,
                 .field = "gnss",
                 .found = fmt::format("{} usable fixes", recording.gnss.size()),
                 .expected = "a recording with GNSS positions",
                 .advice = "see the findings for what was removed"});
  }
  if (const auto n = mark_astray(map, recording, options.inference.radius); n > 0) {
    result.record.findings.push_back({"gnss", "far from any track", recording.gnss.front().time,
                                      recording.gnss.back().time, n, Finding::Action::noted,
                                      "used to find the path only"});
  }
  const auto spans = find_journeys(recording, map.network, options.journeys, result.record);
  for (const auto& span : spans) {
    const auto knots = make_knots(recording, span, map.network, options);
    const auto stretches = infer_paths(map, knots, options.inference, constraints);
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const auto& stretch = stretches[s];
      const Time from =
          s == 0 ? std::max(knots[stretch.first].time, recording.gnss[span.first].time) : knots[stretch.first].time;
      const Time to = knots[stretch.last].time;
      if (s > 0) {
        result.record.findings.push_back({"gnss", "no way on the map", knots[stretches[s - 1].last].time, from, 1,
                                          Finding::Action::split, "a hole in the map, or fixes far from any track"});
      }
      if ((to - from).seconds() < options.journeys.shortest) continue;
      JourneySpan part = span;
      part.starts_standing = span.starts_standing && s == 0;
      part.ends_standing = span.ends_standing && s + 1 == stretches.size();
      const auto epochs = make_epochs(recording, part, from, to, map.network, options);
      auto journey = solve(map, epochs, part, stretch.hypotheses, options);
      for (const auto& f : journey.paths.front().residuals) {
        if (f.weight > 0.0F) continue;
        result.record.rejections.push_back({"gnss", recording.gnss[f.fix].time, "innovation",
                                            std::sqrt(static_cast<double>(f.nis)), std::sqrt(options.gnss.gate)});
      }
      result.journeys.push_back(std::move(journey));
    }
    if (stretches.empty()) {
      result.record.findings.push_back({"gnss", "off the map", recording.gnss[span.first].time,
                                        recording.gnss[span.last].time, span.last - span.first + 1,
                                        Finding::Action::removed, "no track near any fix of this journey"});
    }
  }
  if (result.journeys.empty() && !spans.empty()) return tl::unexpected(outside(map, recording));
  return result;
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
