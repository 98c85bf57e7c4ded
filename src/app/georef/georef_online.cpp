// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef_online.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/georef/journeys.hpp"
#include "versine/georef/stamping.hpp"

namespace versine::app {

namespace {
using georef::OnlineDecision;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void feed(const georef::Map& map, const georef::Recording& r, const georef::Options& options,
          const georef::OnlineOptions& online, OnlineReplay& out) {
  georef::OnlineGeoreferencer live(map, options, online);
  std::size_t imu = 0;
  for (const auto& fix : r.gnss) {
    for (; imu < r.imu.size() && !(fix.time < r.imu[imu].time); ++imu) live.add(r.imu[imu], r.has_turn_rate);
    if (const auto p = live.add(fix)) out.positions.push_back(*p);
    for (auto& d : live.take_decisions()) out.decisions.push_back(d);
  }
  out.restarts = live.restarts();
}

void compare(const georef::Map& map, const georef::RecordingResult& offline, OnlineReplay& out) {
  georef::PositionCursor cursor(map, offline);
  double square = 0.0;
  std::size_t same = 0, on_track = 0, inside = 0;
  std::vector<double> distances;
  for (const auto& p : out.positions) {
    const auto q = cursor.at(p.time);
    if (!q) continue;
    const bool agree = p.track == q->track;
    on_track += agree ? 1 : 0;
    inside += agree && std::abs(p.track_distance - q->track_distance) <= 1.96 * p.sigma ? 1 : 0;
    if (!(p.sigma < OnlineReplay::sure)) {
      ++out.unsure;
      continue;
    }
    const double d = (p.point - q->point).norm();
    distances.push_back(d);
    square += d * d;
    same += agree ? 1 : 0;
  }
  out.compared = distances.size();
  if (on_track > 0) out.coverage = static_cast<double>(inside) / static_cast<double>(on_track);
  if (distances.empty()) return;
  const auto n = static_cast<double>(distances.size());
  out.same_track = static_cast<double>(same) / n;
  out.rms = std::sqrt(square / n);
  out.p95 = quantile(distances, 0.95);
}

/// Whether the offline path of the time takes this leg.
bool agrees(const georef::RecordingResult& offline, const OnlineDecision& d) {
  for (const auto& j : offline.journeys) {
    const auto margin = Duration::from_seconds(5.0);
    if (d.passed + margin < j.start || j.end() + margin < d.passed) continue;
    const auto& path = j.paths.front().coordinates.path();
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      if (path[i] == d.from && path[i + 1] == d.to) return true;
    }
  }
  return false;
}

void add_up_decisions(const georef::RecordingResult& offline, OnlineReplay& out) {
  std::vector<double> seconds, metres;
  for (const auto& d : out.decisions) {
    out.revised += d.revised ? 1 : 0;
    if (d.kind != OnlineDecision::Kind::leg) continue;
    ++out.legs;
    out.wrong += agrees(offline, d) ? 0 : 1;
    seconds.push_back((d.decided - d.passed).seconds());
    metres.push_back(d.metres);
  }
  out.median_seconds = quantile(seconds, 0.5), out.worst_seconds = quantile(seconds, 1.0);
  out.median_metres = quantile(metres, 0.5), out.worst_metres = quantile(metres, 1.0);
}

const char* name_of(OnlineDecision::Kind kind) {
  return kind == OnlineDecision::Kind::start ? "start" : kind == OnlineDecision::Kind::leg ? "leg" : "reversal";
}

std::string oriented(const georef::Map& map, network::OrientedTrack t) {
  return (t.reversed ? "-" : "+") + map.network.tracks[t.track].id;
}

Expected<void> write(const std::filesystem::path& path, const fmt::memory_buffer& text) {
  std::ofstream stream(path, std::ios::binary);
  if (stream.write(text.data(), static_cast<std::streamsize>(text.size())).flush()) return {};
  return fail({.file = path.string(),
               .found = "a file that cannot be written",
               .expected = "space on the disk",
               .advice = "free some space"});
}
}  // namespace

OnlineReplay replay_online(const georef::Map& map, georef::Recording recording, const georef::RecordingResult& offline,
                           const georef::Options& options, const georef::OnlineOptions& online) {
  OnlineReplay out;
  out.name = recording.name;
  georef::put_in_order(recording);
  const auto begin = std::clock();
  feed(map, recording, options, online, out);
  out.seconds_cpu = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  compare(map, offline, out);
  add_up_decisions(offline, out);
  return out;
}

Expected<void> write_online_csv(const std::filesystem::path& folder, const georef::Map& map,
                                const std::vector<OnlineReplay>& replays) {
  fmt::memory_buffer positions, decisions;
  const auto to = std::back_inserter(positions), also = std::back_inserter(decisions);
  fmt::format_to(to,
                 "recording,time_s,latitude_deg,longitude_deg,track,reversed,track_distance_m,speed_mps,sigma_m,"
                 "probability,hypotheses\n");
  fmt::format_to(also, "recording,kind,from,to,passed_s,decided_s,latency_s,latency_m,probability,revised\n");
  for (std::size_t r = 0; r < replays.size(); ++r) {
    for (const auto& p : replays[r].positions) {
      const auto g = map.network.to_geodetic(p.point);
      fmt::format_to(to, "{},{},{:.9f},{:.9f},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{}\n", r + 1, seconds_text(p.time),
                     g.latitude / units::deg, g.longitude / units::deg, map.network.tracks[p.track.track].line_id,
                     p.track.reversed ? 1 : 0, p.track_distance, p.speed, p.sigma, p.probability, p.hypotheses);
    }
    for (const auto& d : replays[r].decisions) {
      fmt::format_to(also, "{},{},{},{},{},{},{:.3f},{:.2f},{:.5f},{}\n", r + 1, name_of(d.kind), oriented(map, d.from),
                     oriented(map, d.to), seconds_text(d.passed), seconds_text(d.decided),
                     (d.decided - d.passed).seconds(), d.metres, d.probability, d.revised ? 1 : 0);
    }
  }
  if (const auto done = write(folder / "online.csv", positions); !done) return done;
  return write(folder / "online_decisions.csv", decisions);
}

std::string online_text(const OnlineReplay& r) {
  return fmt::format(
      "{}: {} positions online, {} of them with a sigma below {:.0f} m: {:.2f} % of these on the offline path's track, "
      "RMS {:.2f} m and 95 % within {:.2f} m of it; of all {:.1f} % within 1.96 sigma\n  {} legs decided after {:.1f} "
      "s, "
      "{:.0f} m (median; at worst {:.1f} s, {:.0f} m), {} against the offline path, {} revised, {} restarts; {:.3f} s "
      "of "
      "processor time\n",
      r.name, r.positions.size(), r.compared, OnlineReplay::sure, 100.0 * r.same_track, r.rms, r.p95,
      100.0 * r.coverage, r.legs, r.median_seconds, r.median_metres, r.worst_seconds, r.worst_metres, r.wrong,
      r.revised, r.restarts, r.seconds_cpu);
}

}  // namespace versine::app
