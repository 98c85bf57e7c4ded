// SPDX-License-Identifier: Apache-2.0
#include "georef_score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace versine::benchmarks {

namespace {

std::vector<std::string> names(const georef::Map& map, const georef::PathSolution& p) {
  std::vector<std::string> out;
  const auto& starts = p.coordinates.starts();
  for (std::size_t i = 0; i < p.coordinates.path().size(); ++i) {
    if (starts[i + 1] <= p.motion.distance.front() || starts[i] >= p.motion.distance.back()) continue;
    out.push_back(map.network.tracks[p.coordinates.path()[i].track].id);
  }
  return out;
}

/// Errors along the path of a journey whose path is right.
void measure(const georef::Map& map, const georef::JourneyResult& j,
             const std::vector<const simulation::ProgressPoint*>& points, const simulation::SimulatedRecording& r,
             const std::function<bool(const Eigen::Vector2d&)>& bad, Score& score) {
  const auto& p = j.paths.front();
  const auto& path = p.coordinates.path();
  std::size_t i = 0;
  std::vector<Time> bridge;
  for (const auto& f : r.gnss) {
    if (bad(map.network.to_map(f.position))) bridge.push_back(f.time);
  }
  for (const auto* t : points) {
    while (i < path.size() && map.network.tracks[path[i].track].id != t->track) ++i;
    if (i == path.size()) return;
    const double length = map.network.tracks[path[i].track].line.length();
    const double truth =
        p.coordinates.starts()[i] + (path[i].reversed ? length - t->track_distance : t->track_distance);
    const auto k = std::min(j.steps - 1, static_cast<std::size_t>(std::lround((t->time - j.start).seconds() / j.grid)));
    const double error = p.motion.distance[k] - truth, sigma = p.motion.sigma_distance[k];

    const bool good =
        std::none_of(bridge.begin(), bridge.end(), [&](Time b) { return std::abs((t->time - b).seconds()) < 10.0; });
    (good ? score.square_good : score.square_bad) += error * error;
    ++(good ? score.n_good : score.n_bad);
    score.inside += std::abs(error) < 1.96 * sigma;
    score.normalised += error * error / (sigma * sigma);
  }
}

}  // namespace

void add(Score& to, const Score& s) {
  to.journeys += s.journeys, to.right += s.right, to.failed += s.failed, to.hypotheses += s.hypotheses;
  to.n_good += s.n_good, to.n_bad += s.n_bad, to.inside += s.inside, to.seconds += s.seconds, to.hours += s.hours;
  to.square_good += s.square_good, to.square_bad += s.square_bad, to.normalised += s.normalised;
  to.paths.insert(to.paths.end(), s.paths.begin(), s.paths.end());
  to.switches.insert(to.switches.end(), s.switches.begin(), s.switches.end());
}

void judge(const georef::Map& map, const georef::JourneyResult& j, const simulation::SimulatedRecording& r,
           const std::function<bool(const Eigen::Vector2d&)>& bad,
           const std::function<void(const std::vector<std::string>&, const std::vector<std::string>&)>& wrong,
           Score& score) {
  std::vector<const simulation::ProgressPoint*> points;
  std::vector<std::string> driven;
  for (const auto& p : r.truth.progress) {
    if (p.time < j.start || j.end() < p.time) continue;
    points.push_back(&p);
    if (driven.empty() || driven.back() != p.track) driven.push_back(p.track);
  }
  if (points.empty()) return;
  ++score.journeys;
  score.hypotheses += j.paths.size();
  for (std::size_t i = 0; i < j.paths.size(); ++i) {
    const bool right = names(map, j.paths[i]) == driven;
    score.paths.push_back({j.paths[i].probability, right});
    if (i == 0 && right) ++score.right;
    if (i == 0 && !right) wrong(driven, names(map, j.paths[i]));
  }
  for (const auto& s : j.switches) {
    const auto& from = map.network.tracks[s.from.track].id;
    const auto at = std::find(driven.begin(), driven.end(), from);
    if (at == driven.end() || at + 1 == driven.end()) continue;
    score.switches.push_back({s.probability, *(at + 1) == map.network.tracks[s.to.track].id});
  }
  if (names(map, j.paths.front()) == driven) measure(map, j, points, r, bad, score);
}

Reliability reliability(const std::string& name, const std::vector<Decision>& decisions) {
  constexpr std::array edges{0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0};
  Reliability out{.rows = {}, .curve = {.name = name, .x = {}, .y = {}, .style = report::CurveStyle::points}};
  for (const auto& d : decisions) out.brier += std::pow(d.probability - (d.right ? 1.0 : 0.0), 2);
  out.brier /= static_cast<double>(std::max<std::size_t>(1, decisions.size()));
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const bool last = b + 2 == edges.size();
    double told = 0.0, right = 0.0, n = 0.0;
    for (const auto& d : decisions) {
      if (d.probability < edges[b] || (!last && d.probability >= edges[b + 1])) continue;
      told += d.probability, right += d.right ? 1.0 : 0.0, n += 1.0;
    }
    if (n == 0.0) continue;
    out.rows += fmt::format("| {} | {} to {} | {:.0f} | {:.2f} % | {:.2f} % |\n", name, edges[b], edges[b + 1], n,
                            100.0 * told / n, 100.0 * right / n);
    if (n < 10.0) continue;
    out.curve.x.push_back(told / n), out.curve.y.push_back(right / n);
  }
  return out;
}

}  // namespace versine::benchmarks
