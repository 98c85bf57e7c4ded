// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "versine/app/georef.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {

using json = nlohmann::ordered_json;
using georef::JourneyResult;

/// Rounded, so that files stay small: 1e-7 deg are 11 mm, 1e-9 deg 0.1 mm.
double rounded(double x, double digits) {
  const double f = std::pow(10.0, digits);
  return std::round(x * f) / f;
}

json lon_lat(const georef::Map& map, const Eigen::Vector2d& p) {
  const auto g = map.network.to_geodetic(p);
  return {rounded(g.longitude / units::deg, 8), rounded(g.latitude / units::deg, 8)};
}

json evidence_json(const georef::Evidence& e) {
  return {{"position", rounded(e.position, 3)},
          {"speed", rounded(e.speed, 3)},
          {"turn_rate", rounded(e.turn_rate, 3)},
          {"route", rounded(e.route, 3)}};
}

json ids(const georef::Map& map, const network::Path& path) {
  json out = json::array();
  for (const auto& t : path) out.push_back(map.network.tracks[t.track].id);
  return out;
}

/// The part of a path that was driven, its vertices and both ends.
json line_json(const georef::Map& map, const georef::PathSolution& p) {
  const double from = std::clamp(p.motion.distance.front(), 0.0, p.coordinates.length());
  const double to = std::clamp(p.motion.distance.back(), from, p.coordinates.length());
  json out = json::array();
  const auto add = [&](const Eigen::Vector2d& place, double d) {
    json point = lon_lat(map, place);
    point.push_back(rounded(d, 3));
    out.push_back(std::move(point));
  };
  add(p.coordinates.position(from), from);
  const auto distances = p.coordinates.distances();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] > from && distances[i] < to) add(p.coordinates.points()[i], distances[i]);
  }
  add(p.coordinates.position(to), to);
  return out;
}

json path_json(const georef::Map& map, const georef::PathSolution& p, std::size_t number) {
  json tracks = json::array();
  for (std::size_t i = 0; i < p.coordinates.path().size(); ++i) {
    const auto t = p.coordinates.path()[i];
    tracks.push_back({{"id", map.network.tracks[t.track].id},
                      {"line", map.network.tracks[t.track].line_id},
                      {"reversed", t.reversed},
                      {"from_m", rounded(p.coordinates.starts()[i], 3)},
                      {"to_m", rounded(p.coordinates.starts()[i + 1], 3)}});
  }
  return {{"path", number},
          {"probability", p.probability},
          {"log_likelihood", rounded(p.evidence.likelihood(), 3)},
          {"log_prior", rounded(p.evidence.route, 3)},
          {"evidence", evidence_json(p.evidence)},
          {"tracks", tracks},
          {"from_m", rounded(p.motion.distance.front(), 3)},
          {"to_m", rounded(p.motion.distance.back(), 3)},
          {"line", line_json(map, p)}};
}

json switches_json(const georef::Map& map, const JourneyResult& j) {
  json out = json::array();
  const auto& best = j.paths.front().coordinates;
  for (std::size_t i = 0, k = 0; i + 1 < best.path().size() && k < j.switches.size(); ++i) {
    const auto& s = j.switches[k];
    if (best.path()[i] != s.from || best.path()[i + 1] != s.to) continue;
    const json place = lon_lat(map, best.position(best.starts()[i + 1]));
    out.push_back({{"time_s", s.time.seconds()},
                   {"distance_m", rounded(best.starts()[i + 1], 3)},
                   {"longitude", place[0]},
                   {"latitude", place[1]},
                   {"from", map.network.tracks[s.from.track].id},
                   {"to", map.network.tracks[s.to.track].id},
                   {"probability", s.probability}});
    ++k;
  }
  return out;
}

json ambiguous_json(const georef::Map& map, const JourneyResult& j) {
  json out = json::array();
  for (const auto& a : j.ambiguous) {
    json paths = json::array();
    for (const auto p : a.paths) paths.push_back(p + 1);
    out.push_back({{"from_s", a.from.seconds()},
                   {"to_s", a.to.seconds()},
                   {"from_m", rounded(a.begin, 3)},
                   {"to_m", rounded(a.end, 3)},
                   {"taken", ids(map, a.taken)},
                   {"alternative", ids(map, a.alternative)},
                   {"paths", paths},
                   {"probability", a.probability},
                   {"evidence", evidence_json(a.evidence)}});
  }
  return out;
}

json journey_json(const georef::Map& map, const JourneyResult& j, std::size_t number) {
  const auto& best = j.paths.front();
  json paths = json::array();
  for (std::size_t p = 0; p < j.paths.size(); ++p) paths.push_back(path_json(map, j.paths[p], p + 1));
  const auto rejected =
      std::count_if(best.residuals.begin(), best.residuals.end(), [](const auto& f) { return f.weight == 0.0F; });
  return {{"journey", number},
          {"start_ns", j.start.ns},
          {"from_s", j.start.seconds()},
          {"to_s", j.end().seconds()},
          {"grid_s", j.grid},
          {"length_m", rounded(best.motion.distance.back() - best.motion.distance.front(), 3)},
          {"starts_standing", j.starts_standing},
          {"ends_standing", j.ends_standing},
          {"entropy_nat", j.entropy},
          {"fixes", best.residuals.size()},
          {"rejected", rejected},
          {"paths", paths},
          {"switches", switches_json(map, j)},
          {"ambiguous", ambiguous_json(map, j)}};
}

json recording_json(const georef::Map& map, const GeorefOutcome& o) {
  json out{{"name", o.name}};
  if (!o.result) {
    out["error"] = o.result.error().message();
    return out;
  }
  constexpr std::array scales{"gps", "utc", "recorder"};
  out["time_scale"] = scales[static_cast<std::size_t>(o.result->scale)];
  out["findings"] = json::array();
  for (const auto& f : o.result->record.findings) {
    out["findings"].push_back({{"sensor", f.sensor},
                               {"kind", f.kind},
                               {"from_s", f.from.seconds()},
                               {"to_s", f.to.seconds()},
                               {"count", f.count},
                               {"action", to_string(f.action)},
                               {"detail", f.detail}});
  }
  out["journeys"] = json::array();
  const auto& journeys = o.result->journeys;
  for (std::size_t k = 0; k < journeys.size(); ++k) out["journeys"].push_back(journey_json(map, journeys[k], k + 1));
  return out;
}

/// Tracks within 500 m of any reported path.
std::set<network::TrackIndex> neighbourhood(const georef::Map& map, const std::vector<GeorefOutcome>& outcomes) {
  std::set<network::TrackIndex> out;
  for (const auto& o : outcomes) {
    if (!o.result) continue;
    for (const auto& j : o.result->journeys) {
      for (const auto& p : j.paths) {
        const double to = p.motion.distance.back() + 200.0;
        for (double d = p.motion.distance.front(); d < to; d += 200.0) {
          const Eigen::Vector2d at = p.coordinates.position(std::min(d, p.motion.distance.back()));
          for (const auto& hit : map.index.near(at, 500.0)) out.insert(hit.track);
        }
      }
    }
  }
  return out;
}

json network_json(const georef::Map& map, const std::set<network::TrackIndex>& tracks) {
  json features = json::array();
  for (const auto t : tracks) {
    const auto& track = map.network.tracks[t];
    json line = json::array();
    for (const auto& p : track.line.points()) line.push_back(lon_lat(map, p));
    features.push_back(
        {{"type", "Feature"},
         {"properties", {{"id", track.id}, {"line", track.line_id}, {"length_m", rounded(track.line.length(), 3)}}},
         {"geometry", {{"type", "LineString"}, {"coordinates", std::move(line)}}}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

Expected<void> write(const std::filesystem::path& path, const json& content) {
  std::ofstream stream(path, std::ios::binary);
  if ((stream << content.dump() << '\n').flush()) return {};
  return fail({.file = path.string(),
               .found = "a file that cannot be written",
               .expected = "space on the disk",
               .advice = "free some space"});
}

}  // namespace

Expected<void> write_georef_index(const std::filesystem::path& folder, const georef::Map& map,
                                  const std::vector<GeorefOutcome>& outcomes) {
  json index{{"format", "versine-georef 1"},
             {"network",
              {{"file", map.network.file},
               {"geojson", "network.geojson"},
               {"crs", map.network.projection.definition()},
               {"tracks", map.network.tracks.size()},
               {"warnings", map.network.record.warnings}}},
             {"recordings", json::array()}};
  for (const auto& o : outcomes) index["recordings"].push_back(recording_json(map, o));
  if (auto done = write(folder / "georef.json", index); !done) return done;
  return write(folder / "network.geojson", network_json(map, neighbourhood(map, outcomes)));
}

}  // namespace versine::app
