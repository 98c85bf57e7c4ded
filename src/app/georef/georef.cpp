// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "versine/app/job_run.hpp"
#include "versine/app/progress_file.hpp"
#include "versine/app/report.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/parallel.hpp"
#include "versine/io/georef_result.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"

namespace versine::app {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

Expected<GeorefConfig> read_job(const fs::path& job, std::span<const std::string> overrides) {
  GeorefConfig config;
  if (auto read = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !read) {
    return tl::unexpected(read.error());
  }
  const auto wrong = [&](const char* field, std::string found, const char* expected, const char* advice) {
    return fail(
        {.file = job.string(), .field = field, .found = std::move(found), .expected = expected, .advice = advice});
  };
  if (config.job != "georef") return wrong("job", "'" + config.job + "'", "\"georef\"", "run the command of that name");
  if (config.recordings.empty() && config.tables.empty()) {
    return wrong("recordings", "nothing", "recordings to be georeferenced",
                 "name files in 'recordings', or add [[recording]] tables");
  }
  if (auto read = load_constraints(config); !read) return tl::unexpected(read.error());
  return config;
}

/// What one entry of the job came to: a file may hold many recordings.
struct Entry {
  std::vector<GeorefOutcome> outcomes;
  std::vector<georef::Recording> again;  ///< for the online replay, one an outcome
  std::vector<Error> faults;
};

class Solver {
 public:
  Solver(const GeorefConfig& config, const georef::Map& map)
      : config_(config),
        map_(map),
        options_(config.options),
        entries_(config.recordings.size() + config.tables.size()) {}

  /// Entries on many threads, each with a projection of its own; the order of results is that of the job.
  [[nodiscard]] std::vector<Entry> run(int threads, Progress& progress) {
    const std::size_t cores = thread_count(threads), count = std::min(entries_.size(), cores);
    // What recordings leave over goes to the paths of each.
    options_.threads = cores / std::max<std::size_t>(1, count);
    std::mutex mutex;
    std::size_t done = 0;
    std::vector<geodesy::Projection> idle(std::max<std::size_t>(1, count), map_.network.projection);
    parallel_for(entries_.size(), count, [&](std::size_t i) {
      if (progress.cancelled()) return;
      std::unique_lock lock(mutex);
      geodesy::Projection projection = std::move(idle.back());
      idle.pop_back();
      lock.unlock();
      entries_[i] = solve(i, projection);
      lock.lock();
      idle.push_back(std::move(projection));
      progress.report("journeys", static_cast<double>(++done) / static_cast<double>(entries_.size()));
    });
    return std::move(entries_);
  }

 private:
  [[nodiscard]] Entry solve(std::size_t i, const geodesy::Projection& projection) const {
    Entry entry;
    const auto add = [&](georef::Recording&& r) {
      std::string name = r.name;
      if (config_.run_online) entry.again.push_back(r);
      entry.outcomes.push_back(
          {std::move(name), georef::georeference(map_, std::move(r), options_, config_.constraints, &projection)});
    };
    if (i >= config_.recordings.size()) {
      const auto& c = config_.tables[i - config_.recordings.size()];
      auto r = load_recording(c);
      if (r) {
        add(std::move(*r));
      } else {
        entry.outcomes.push_back({c.name.empty() ? c.gnss.file.written : c.name, tl::unexpected(r.error())});
      }
      return entry;
    }
    const InputPath& file = config_.recordings[i];
    auto recordings = load_recordings(file.path, entry.faults);
    if (!recordings) {
      entry.outcomes.push_back({file.written, tl::unexpected(recordings.error())});
      return entry;
    }
    for (auto& r : *recordings) {
      // As the user wrote it: a folder's place is no part of a recording's name.
      const std::string full = file.path.string();
      if (r.name.starts_with(full)) r.name = file.written + r.name.substr(full.size());
      add(std::move(r));
    }
    return entry;
  }

  const GeorefConfig& config_;
  const georef::Map& map_;
  georef::Options options_;
  std::vector<Entry> entries_;
};

nlohmann::ordered_json summary_of(const GeorefConfig& config, const georef::Map& map,
                                  const std::vector<GeorefOutcome>& outcomes, const std::vector<Error>& faults) {
  nlohmann::ordered_json out;
  if (!config.title.empty()) out["title"] = config.title;
  out["network"] = {{"tracks", map.network.tracks.size()}, {"warnings", map.network.record.warnings.size()}};
  out["faults"] = nlohmann::ordered_json::array();
  for (const auto& f : faults) out["faults"].push_back(f.message());
  out["recordings"] = nlohmann::ordered_json::array();
  for (const auto& o : outcomes) {
    nlohmann::ordered_json r{{"name", o.name}};
    if (!o.result) r["error"] = o.result.error().message();
    if (o.result) {
      r["journeys"] = nlohmann::ordered_json::array();
      for (const auto& j : o.result->journeys) {
        nlohmann::ordered_json tracks = nlohmann::ordered_json::array();
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
    }
    out["recordings"].push_back(std::move(r));
  }
  return out;
}

Expected<void> add_inputs(io::Run& run, const GeorefConfig& c, const fs::path& job) {
  const auto add = [&](const char* role, const std::string& written, const fs::path& path) -> Expected<void> {
    auto file = io::describe_input(role, written, path);
    // A recording that is not there is told among the faults; the rest has a result.
    if (file) run.inputs.push_back(std::move(*file));
    return {};
  };
  auto done = add("job", job.string(), job);
  if (done) done = add("network", c.network.written, c.network.path);
  if (done && !c.constraints_file.empty())
    done = add("constraints", c.constraints_file.written, c.constraints_file.path);
  for (const auto& r : c.recordings) done = add("recording", r.written, r.path);
  for (const auto& r : c.tables) {
    for (const InputPath* f : {&r.gnss.file, &r.imu.file, &r.speed.file, &r.odometer.file}) {
      if (!f->empty()) done = add("recording", f->written, f->path);
    }
  }
  return done;
}

/// Everything of the result folder but run.json.
Expected<void> write_results(const GeorefConfig& c, const fs::path& folder, const georef::Map& map,
                             const std::vector<GeorefOutcome>& outcomes, const std::vector<OnlineReplay>& online,
                             int threads, Progress& progress) {
  std::vector<const georef::RecordingResult*> results;
  for (const auto& o : outcomes) results.push_back(o.result ? &*o.result : nullptr);
  // The map's projection is for one thread at a time: of these, only the tables and the index ask it.
  const std::string crs = map.network.projection.wkt();
  const std::array<std::function<Expected<void>()>, 3> parts{
      [&]() -> Expected<void> {
        if (!c.gpkg) return {};
        return io::write_georef_gpkg(folder / "result.gpkg", map, crs, results, c.csv_interval);
      },
      [&] {
        auto done = write_georef_tables(folder, map, outcomes, c.options, c.csv_interval);
        if (done) done = write_georef_index(folder, map, outcomes);
        if (done && c.run_online) done = write_online_csv(folder, map, online);
        return done;
      },
      [&]() -> Expected<void> {
        if (!c.hdf5) return {};
        return io::write_georef_hdf5(folder / "georef.h5", map, results);
      }};
  std::array<Expected<void>, 3> written;
  parallel_for(parts.size(), thread_count(threads), [&](std::size_t i) { written[i] = parts[i](); });
  Expected<void> done;
  for (const auto& one : written) {
    if (done) done = one;
  }
  if (done) done = stamp_monitoring(folder, map, outcomes, c.monitoring, progress);
  return done;
}

}  // namespace

Expected<GeorefRun> run_georef(const fs::path& job, std::span<const std::string> overrides, const fs::path& output,
                               int threads, bool online, Progress& progress) {
  auto config = read_job(job, overrides);
  if (!config) return tl::unexpected(config.error());
  if (auto done = check_report(config->report); !done) return tl::unexpected(done.error());
  config->run_online = online;
  // Beside reading and georeferencing; awaited when it goes out of scope, also after an error.
  std::jthread prepared;
  if (config->gpkg) prepared = std::jthread(io::prepare_georef_gpkg);
  auto folder = io::ResultFolder::create(result_target(job, output));
  if (!folder) return tl::unexpected(folder.error());
  ProgressFile visible(progress, *folder);
  io::Run run = begin_run("georef");
  auto last = Clock::now();
  const auto stage = [&](const char* name) {
    const auto now = Clock::now();
    run.timings_s.emplace_back(name, std::chrono::duration<double>(now - last).count());
    last = now;
  };
  visible.report("map", 0.0);
  const auto map = load_map(*config);
  if (!map) return tl::unexpected(map.error());
  if (auto good = georef::check(**map, config->constraints); !good) {
    Error error = good.error();
    error.file = config->constraints_file.empty() ? job.string() : config->constraints_file.written;
    return tl::unexpected(error);
  }
  stage("map");
  auto entries = Solver(*config, **map).run(threads, visible);
  if (visible.cancelled()) return fail({.found = "cancelled"});
  stage("journeys");
  std::vector<GeorefOutcome> outcomes;
  std::vector<OnlineReplay> replays;
  GeorefRun out;
  std::size_t journeys = 0, failed = 0;
  for (auto& e : entries) {
    out.faults.insert(out.faults.end(), e.faults.begin(), e.faults.end());
    for (std::size_t i = 0; i < e.again.size(); ++i) {
      if (const auto& r = e.outcomes[i].result) {
        replays.push_back(replay_online(**map, std::move(e.again[i]), *r, config->options, config->online));
      }
    }
    for (auto& o : e.outcomes) outcomes.push_back(std::move(o));
  }
  for (const auto& o : outcomes) {
    if (o.result) {
      journeys += o.result->journeys.size();
      run.time_scale = o.result->scale;
      run.record.append(o.result->record);
    } else {
      out.faults.push_back(o.result.error());
      ++failed;
    }
  }
  if (failed == outcomes.size()) return tl::unexpected(out.faults.front());
  visible.report("writing", 0.0);
  if (auto done = write_results(*config, folder->folder(), **map, outcomes, replays, threads, visible); !done)
    return tl::unexpected(done.error());
  if (auto done = add_inputs(run, *config, job); !done) return tl::unexpected(done.error());
  stage("write");
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, *config); });
  run.results_json = summary_of(*config, **map, outcomes, out.faults).dump();
  if (auto done = io::write_run_json(folder->path("run.json"), run); !done) return tl::unexpected(done.error());
  out.folder = folder->target();
  out.summary_json = io::run_json(run);
  out.summary_text = fmt::format(
      "{} recordings, {} journeys, {} failed; map {:.2f} s, journeys {:.2f} s, writing {:.2f} s\n", outcomes.size(),
      journeys, failed, run.timings_s[0].second, run.timings_s[1].second, run.timings_s[2].second);
  for (const auto& r : replays) out.summary_text += online_text(r);
  if (auto done = write_job_report(config->report, folder->folder(), folder->target()); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = folder->commit(); !done) return tl::unexpected(done.error());
  return out;
}

namespace {
void describe_defaults(ConfigVisitor& v) {
  GeorefConfig config;
  describe(v, config);
}

Expected<std::vector<std::string>> check_job(const fs::path& job, std::span<const std::string> overrides) {
  const auto config = read_job(job, overrides);
  if (!config) return tl::unexpected(config.error());
  const auto map = load_map(*config);
  if (!map) return tl::unexpected(map.error());
  if (auto good = georef::check(**map, config->constraints); !good) return tl::unexpected(good.error());
  std::vector<std::string> lines{fmt::format(
      "map: {} tracks, {} joints, {} remarks ('versine network check' lists them)", (*map)->network.tracks.size(),
      (*map)->network.joints.size(), (*map)->network.record.warnings.size())};
  const auto add = [&](const georef::Recording& r) {
    lines.push_back(
        fmt::format("{}: {} fixes, {} IMU samples, {} speeds", r.name, r.gnss.size(), r.imu.size(), r.speed.size()));
  };
  for (const auto& file : config->recordings) {
    std::vector<Error> faults;
    const auto recordings = load_recordings(file.path, faults);
    if (!recordings) return tl::unexpected(recordings.error());
    for (const auto& r : *recordings) add(r);
    for (const auto& f : faults) lines.push_back("left out: " + f.message());
  }
  for (const auto& c : config->tables) {
    const auto r = load_recording(c);
    if (!r) return tl::unexpected(r.error());
    add(*r);
  }
  if (!config->constraints.empty()) lines.push_back(fmt::format("{} constraints", config->constraints.size()));
  return lines;
}
}  // namespace

const JobKind georef_job{"georef", "Recordings of in-service vehicles are put on the tracks of a railway map.",
                         describe_defaults, check_job};

}  // namespace versine::app
