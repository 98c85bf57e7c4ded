// SPDX-License-Identifier: Apache-2.0
#include "posterior.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace versine::georef {

namespace {

bool has_step(const network::Path& path, network::OrientedTrack from, const network::OrientedTrack* to) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (path[i] == from && (to == nullptr || path[i + 1] == *to)) return true;
  }
  return false;
}

Time time_of(const JourneyResult& j, std::size_t step) {
  return j.start + Duration::from_seconds(j.grid * static_cast<double>(step));
}

/// The first step at which the vehicle was at a distance on a path.
std::size_t step_at(const JourneyResult& j, const PathSolution& p, double distance) {
  const auto& d = p.motion.distance;
  const auto at = static_cast<std::size_t>(std::lower_bound(d.begin(), d.end(), distance) - d.begin());
  return std::min(at, j.steps - 1);
}

/// A run of tracks in which two paths differ: [first, last) of each.
struct Difference {
  std::size_t taken_first, taken_last, first, last;
};
std::vector<Difference> differences(const network::Path& best, const network::Path& other) {
  std::unordered_multimap<std::uint32_t, std::size_t> at;
  for (std::size_t i = 0; i < best.size(); ++i) at.emplace(best[i].state(), i);
  std::vector<Difference> out;
  std::size_t i = 0, j = 0;  // both paths agree before these
  for (std::size_t k = 0; k <= other.size(); ++k) {
    std::size_t match = best.size();
    if (k < other.size()) {
      const auto [begin, end] = at.equal_range(other[k].state());
      for (auto it = begin; it != end; ++it) {
        if (it->second >= i) match = std::min(match, it->second);
      }
      if (match == best.size()) continue;
    }
    if (match > i || k > j) out.push_back({i, match, j, k});
    i = match + 1, j = k + 1;
  }
  return out;
}

}  // namespace

void set_posterior(std::vector<PathSolution>& paths) {
  double best = -INFINITY, sum = 0.0;
  for (const auto& p : paths) best = std::max(best, p.evidence.total());
  for (auto& p : paths) sum += p.probability = std::exp(p.evidence.total() - best);
  for (auto& p : paths) p.probability /= sum;
  std::stable_sort(paths.begin(), paths.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
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
    const auto at = step_at(j, best, best.coordinates.starts()[i + 1]);
    j.switches.push_back({path[i], path[i + 1], same / passed, time_of(j, at)});
  }
}

void find_ambiguous(JourneyResult& j) {
  const auto& best = j.paths.front();
  const auto& path = best.coordinates.path();
  const auto& starts = best.coordinates.starts();
  const double first = best.motion.distance.front(), last = best.motion.distance.back();
  for (std::size_t k = 1; k < j.paths.size(); ++k) {
    const auto& other = j.paths[k];
    const auto& way = other.coordinates.path();
    for (const auto& d : differences(path, way)) {
      const auto at = [](const network::Path& p, std::size_t from, std::size_t to) {
        return network::Path(p.begin() + static_cast<std::ptrdiff_t>(from),
                             p.begin() + static_cast<std::ptrdiff_t>(to));
      };
      AmbiguousStretch a;
      a.taken = at(path, d.taken_first, d.taken_last);
      a.alternative = at(way, d.first, d.last);
      const auto same = std::find_if(j.ambiguous.begin(), j.ambiguous.end(), [&](const auto& x) {
        return x.taken == a.taken && x.alternative == a.alternative;
      });
      if (same != j.ambiguous.end()) {
        same->probability += other.probability;
        same->paths.push_back(k);
        continue;
      }
      a.begin = std::clamp(starts[d.taken_first], first, last);
      a.end = std::clamp(starts[d.taken_last], first, last);
      a.from = time_of(j, step_at(j, best, a.begin));
      a.to = time_of(j, step_at(j, best, a.end));
      a.paths = {k};
      a.probability = other.probability;
      a.evidence = best.evidence - other.evidence;
      j.ambiguous.push_back(std::move(a));
    }
  }
  std::stable_sort(j.ambiguous.begin(), j.ambiguous.end(),
                   [](const auto& x, const auto& y) { return x.from < y.from; });
}

}  // namespace versine::georef
