// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/io/georef_result.hpp"
#include "versine/io/journey_brussels.hpp"
#include "versine/io/journey_onboard.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {

namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

bool begins_with(const std::filesystem::path& path, std::string_view bytes) {
  std::ifstream stream(path, std::ios::binary);
  std::string head(bytes.size(), '\0');
  return stream.read(head.data(), static_cast<std::streamsize>(head.size())) && head == bytes;
}

bool is_brussels(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string header;
  std::getline(stream, header);
  return header.find("position_type") != std::string::npos && header.find("timestamp") != std::string::npos;
}

nlohmann::json summary_json(const GeorefSummary& s, const georef::Map& map) {
  nlohmann::json out;
  out["network"] = {
      {"file", map.network.file}, {"tracks", map.network.tracks.size()}, {"warnings", map.network.record.warnings}};
  out["timings_s"] = {{"map", s.seconds_map}, {"solve", s.seconds_solve}, {"write", s.seconds_write}};
  out["faults"] = nlohmann::json::array();
  for (const auto& f : s.faults) out["faults"].push_back(f.message());
  for (const auto& o : s.outcomes) {
    nlohmann::json r{{"name", o.name}};
    if (!o.result) {
      r["error"] = o.result.error().message();
      out["recordings"].push_back(r);
      continue;
    }
    for (const auto& f : o.result->record.findings) {
      r["findings"].push_back({{"sensor", f.sensor},
                               {"kind", f.kind},
                               {"from_s", f.from.seconds()},
                               {"to_s", f.to.seconds()},
                               {"count", f.count},
                               {"action", to_string(f.action)},
                               {"detail", f.detail}});
    }
    r["rejected_fixes"] = o.result->record.rejections.size();
    for (const auto& j : o.result->journeys) {
      nlohmann::json tracks = nlohmann::json::array();
      for (const auto& t : j.paths.front().coordinates.path()) tracks.push_back(map.network.tracks[t.track].id);
      r["journeys"].push_back(
          {{"from_s", j.start.seconds()},
           {"to_s", j.end().seconds()},
           {"length_m", j.paths.front().motion.distance.back() - j.paths.front().motion.distance.front()},
           {"probability", j.paths.front().probability},
           {"paths", j.paths.size()},
           {"entropy_nat", j.entropy},
           {"tracks", tracks}});
    }
    out["recordings"].push_back(r);
  }
  return out;
}

}  // namespace

Expected<std::unique_ptr<georef::Map>> load_map(const GeorefConfig& c) {
  const auto source = io::read_network({c.network.path, c.layer, c.id_field, c.source_crs, c.osm_types});
  if (!source) return tl::unexpected(source.error());
  auto network = network::build(*source, {.crs = c.crs, .snap = c.snap, .largest_turn = c.largest_turn});
  if (!network) return tl::unexpected(network.error());
  return std::make_unique<georef::Map>(std::move(*network));
}

Expected<std::vector<georef::Recording>> load_recordings(const std::filesystem::path& path,
                                                         std::vector<Error>& faults) {
  if (begins_with(path, "\x89HDF\r\n\x1a\n")) {
    auto file = io::read_onboard(path);
    if (!file) return tl::unexpected(file.error());
    faults.insert(faults.end(), file->faults.begin(), file->faults.end());
    return std::move(file->recordings);
  }
  std::vector<georef::Recording> out;
  if (is_brussels(path)) {
    auto log = io::read_brussels_log(path);
    if (!log) return tl::unexpected(log.error());
    out.push_back(std::move(*log));
    return out;
  }
  io::GnssFile file;
  file.table.path = path;
  auto gnss = io::read_gnss(file);
  if (!gnss) return tl::unexpected(gnss.error());
  georef::Recording r;
  r.name = path.string();
  r.gnss = georef::to_fixes(gnss->series);
  r.record = std::move(gnss->record);
  out.push_back(std::move(r));
  return out;
}

Expected<GeorefSummary> run_georef(const GeorefConfig& config, const std::filesystem::path& folder,
                                   Progress& progress) {
  GeorefSummary summary;
  auto begin = Clock::now();
  progress.report("map", 0.0);
  auto map = load_map(config);
  if (!map) return tl::unexpected(map.error());
  summary.seconds_map = since(begin);
  begin = Clock::now();
  for (std::size_t i = 0; i < config.recordings.size(); ++i) {
    progress.report("journeys", static_cast<double>(i) / static_cast<double>(config.recordings.size()));
    if (progress.cancelled()) return fail({.found = "cancelled"});
    auto recordings = load_recordings(config.recordings[i].path, summary.faults);
    if (!recordings) {
      summary.outcomes.push_back({config.recordings[i].written, tl::unexpected(recordings.error())});
      continue;
    }
    for (auto& r : *recordings) {
      const std::string name = r.name;
      georef::Recording again;
      if (config.run_online) again = r;
      summary.outcomes.push_back({name, georef::georeference(**map, std::move(r), config.options, config.constraints)});
      if (const auto& result = summary.outcomes.back().result; result && config.run_online) {
        summary.online.push_back(replay_online(**map, std::move(again), *result, config.options, config.online));
      }
    }
  }
  summary.seconds_solve = since(begin);
  if (std::none_of(summary.outcomes.begin(), summary.outcomes.end(),
                   [](const auto& o) { return o.result.has_value(); })) {
    return tl::unexpected(summary.outcomes.empty() ? Error{.field = "recordings", .found = "none"}
                                                   : summary.outcomes.front().result.error());
  }

  // Into a sibling, which then takes the place of the folder.
  begin = Clock::now();
  progress.report("writing", 0.9);
  const auto fresh = folder.parent_path() / ("." + folder.filename().string() + ".new");
  std::error_code code;
  std::filesystem::remove_all(fresh, code);
  std::filesystem::create_directories(fresh, code);
  if (code)
    return fail({.file = fresh.string(),
                 .found = code.message(),
                 .expected = "a folder that can be written",
                 .advice = "choose another with --output"});
  std::vector<const georef::RecordingResult*> results;
  for (const auto& o : summary.outcomes) results.push_back(o.result ? &*o.result : nullptr);
  auto done = write_georef_csv(fresh, **map, summary.outcomes, config.csv_interval);
  if (done) done = io::write_georef_hdf5(fresh / "georef.h5", **map, results);
  if (done) done = io::write_georef_gpkg(fresh / "result.gpkg", **map, results, config.csv_interval);
  if (done && config.run_online) done = write_online_csv(fresh, **map, summary.online);
  if (done) done = stamp_monitoring(fresh, **map, summary.outcomes, config.monitoring, progress);
  if (!done) {
    std::filesystem::remove_all(fresh, code);
    return tl::unexpected(done.error());
  }
  summary.seconds_write = since(begin);
  nlohmann::json run = summary_json(summary, **map);
  GeorefConfig effective = config;
  run["settings"] = nlohmann::json::parse(config_json([&](ConfigVisitor& v) { describe(v, effective); }));
  std::ofstream(fresh / "run.json") << run.dump(1) << '\n';
  std::filesystem::remove_all(folder, code);
  std::filesystem::rename(fresh, folder, code);
  if (code)
    return fail({.file = folder.string(),
                 .found = code.message(),
                 .expected = "a result folder",
                 .advice = "choose another with --output"});
  return summary;
}

}  // namespace versine::app
