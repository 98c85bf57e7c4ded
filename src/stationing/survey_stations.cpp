// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "versine/stationing/free_station.hpp"

namespace versine::stationing {
namespace {

/// Points that two stations or more left out, with offsets that agree within 3 mm or a third of their size.
std::vector<MovedPoint> find_moved(const std::vector<StationResult>& stations) {
  struct Seen {
    std::string station;
    Eigen::Vector3d offset;
  };
  std::map<std::string, std::vector<Seen>> by_point;
  for (const StationResult& s : stations) {
    for (const Exclusion& e : s.excluded) {
      if (e.reason == Exclusion::Reason::blunder) by_point[e.point].push_back({s.name, e.offset});
    }
  }
  std::vector<MovedPoint> moved;
  for (const auto& [name, seen] : by_point) {
    if (seen.size() < 2) continue;
    MovedPoint m{.name = name};
    for (const Seen& s : seen) m.offset += s.offset / static_cast<double>(seen.size());
    const double tolerance = std::max(3e-3, m.offset.norm() / 3.0);
    for (const Seen& s : seen) {
      if ((s.offset - m.offset).norm() <= tolerance) m.stations.push_back(s.station);
    }
    if (m.stations.size() >= 2) moved.push_back(std::move(m));
  }
  return moved;
}

bool uses(const StationResult& s, const std::string& point) {
  return std::any_of(s.targets.begin(), s.targets.end(), [&](const TargetResult& t) { return t.point == point; });
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

StationingRun compute_stations(std::span<const Stationing> stationings, const ControlNetwork& network,
                               const Instrument& instrument, const FreeStationOptions& options, Progress& progress) {
  StationingRun run;
  std::map<std::string, ReducedStation> reduced;
  for (std::size_t i = 0; i < stationings.size(); ++i) {
    if (progress.cancelled()) break;
    progress.report("free stationing", static_cast<double>(i) / static_cast<double>(stationings.size()));
    const Stationing& s = stationings[i];
    auto r = reduce(s, instrument);
    auto solved =
        r ? free_station(*r, network, instrument, options) : Expected<StationResult>(tl::unexpected(r.error()));
    if (!solved) {
      run.failed.push_back({s.name, s.from, s.to, solved.error()});
      continue;
    }
    reduced[s.name] = std::move(*r);
    run.stations.push_back(std::move(*solved));
  }
  run.moved = find_moved(run.stations);
  if (run.moved.empty()) return run;

  std::vector<std::string> names;
  for (const MovedPoint& m : run.moved) names.push_back(m.name);
  const ControlNetwork rest = network.without(names);
  for (StationResult& s : run.stations) {
    const bool affected = std::any_of(names.begin(), names.end(), [&](const auto& n) { return uses(s, n); });
    if (affected) {
      ReducedStation without = reduced[s.name];
      std::erase_if(without.targets, [&](const Target& t) { return contains(names, t.point); });
      if (auto again = free_station(without, rest, instrument, options)) {
        for (const Target& t : reduced[s.name].targets) {
          if (contains(names, t.point)) again->excluded.push_back({.point = t.point});
        }
        s = std::move(*again);
      }
    }
    for (Exclusion& e : s.excluded) {
      if (contains(names, e.point)) e.reason = Exclusion::Reason::moved;
    }
  }
  return run;
}

}  // namespace versine::stationing
