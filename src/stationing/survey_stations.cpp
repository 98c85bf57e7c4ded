// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "felt_up.hpp"
#include "joint_snooping.hpp"
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

}  // namespace

StationingRun compute_stations(std::span<const Stationing> stationings, const ControlNetwork& network,
                               const Instrument& instrument, const FreeStationOptions& options, Progress& progress) {
  StationingRun run;
  std::vector<ReducedStation> readings;  // of each solved station
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
    readings.push_back(std::move(*r));
    run.stations.push_back(std::move(*solved));
  }
  std::vector<SolvedStation> solved;
  for (std::size_t i = 0; i < readings.size(); ++i) solved.push_back({&readings[i], &run.stations[i]});
  const auto plumb = felt_plumb_lines(solved);
  for (std::size_t i = 0; i < solved.size(); ++i) solved[i].plumb = plumb[i];
  const JointVerdict verdict = snoop_jointly(solved, network, find_moved(run.stations), instrument, options);
  run.moved = verdict.moved;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    StationResult& s = run.stations[i];
    if (verdict.changed[i]) {
      FreeStationOptions decided = options;
      decided.left_out.emplace(verdict.left_out[i].begin(), verdict.left_out[i].end());
      auto again = free_station(readings[i], network, instrument, decided);
      if (verdict.plumb[i] && (!again || again->geometry.grade == GeometryVerdict::Grade::poor)) {
        // The plumb line carries what the targets cannot. Elsewhere it stays out of the result: a filter that has the
        // same accelerometers would count them twice.
        decided.plumb = verdict.plumb[i];
        again = free_station(readings[i], network, instrument, decided);
      }
      if (again) s = std::move(*again);
    }
    for (Exclusion& e : s.excluded) {
      const bool moved =
          std::any_of(run.moved.begin(), run.moved.end(), [&](const auto& m) { return m.name == e.point; });
      if (moved && e.reason == Exclusion::Reason::blunder) e.reason = Exclusion::Reason::moved;
    }
  }
  return run;
}

}  // namespace versine::stationing
