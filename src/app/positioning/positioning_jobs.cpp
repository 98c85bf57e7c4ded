// SPDX-License-Identifier: Apache-2.0
#include "versine/app/positioning_jobs.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gnss_files.hpp"
#include "network_report.hpp"
#include "versine/app/gnss.hpp"
#include "versine/app/job_run.hpp"
#include "versine/app/stationing.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"
#include "versine/io/write_positions.hpp"

namespace versine::app {
namespace {

namespace fs = std::filesystem;

struct GnssJob {
  std::string job = "gnss", title;
  GnssProcessing gnss;
};
void describe(ConfigVisitor& v, GnssJob& j) {
  v.value("job", j.job, {.doc = "Kind of job.", .required = true, .example = "\"gnss\""});
  v.value("title", j.title, {.doc = "For people."});
  v.table("gnss", "Carrier-phase processing through RTKLIB: docs/gnss.md.",
          [&](ConfigVisitor& t) { describe(t, j.gnss); });
}

struct StationingJob {
  std::string job = "stationing", title;
  StationingProcessing total_station;
  bool adjust = false;
  stationing::NetworkOptions network;
};
void describe(ConfigVisitor& v, StationingJob& j) {
  v.value("job", j.job, {.doc = "Kind of job.", .required = true, .example = "\"stationing\""});
  v.value("title", j.title, {.doc = "For people."});
  v.table("total_station", "Raw readings and control points: docs/total-station.md.",
          [&](ConfigVisitor& t) { describe(t, j.total_station); });
  v.table("network", "Adjustment of all stations and points together.", [&](ConfigVisitor& t) {
    t.value("adjust", j.adjust, {.doc = "Adjust the network, and find control points that have moved."});
    t.value("free", j.network.free,
            {.doc = "Control points only place the network; its shape is the readings' alone."});
    t.value("snoop", j.network.snoop, {.doc = "Leave out readings and release control points that fail their test."});
  });
}

template <class Job>
Expected<Job> read_job(const fs::path& path, std::span<const std::string> overrides) {
  Job job;
  if (auto done = read_config(
          path, [&](ConfigVisitor& v) { describe(v, job); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  return job;
}

/// A result folder in the making, with what its run.json will say.
struct Report {
  io::ResultFolder folder;
  io::Run run;
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
};

Expected<Report> open_report(const std::string& command, const fs::path& job, const fs::path& output) {
  auto folder = io::ResultFolder::create(result_target(job, output));
  if (!folder) return tl::unexpected(folder.error());
  Report r{.folder = std::move(*folder), .run = begin_run(command)};
  auto file = io::describe_input("job", job.string(), job);
  if (!file) return tl::unexpected(file.error());
  r.run.inputs.push_back(std::move(*file));
  return r;
}

Expected<PositioningRun> close_report(Report& r, RunRecord record, const nlohmann::ordered_json& summary,
                                      std::string text) {
  r.run.record = std::move(record);
  r.run.results_json = summary.dump();
  r.run.timings_s.emplace_back("all",
                               std::chrono::duration<double>(std::chrono::steady_clock::now() - r.begin).count());
  if (auto done = io::write_run_json(r.folder.path("run.json"), r.run); !done) return tl::unexpected(done.error());
  PositioningRun out{r.folder.target(), std::move(text), io::run_json(r.run)};
  if (auto done = r.folder.commit(); !done) return tl::unexpected(done.error());
  return out;
}

void write_stations(const fs::path& folder, const StationingOutcome& o) {
  std::ofstream stations(folder / "stations.csv"), targets(folder / "targets.csv");
  stations
      << "station,latitude_deg,longitude_deg,height_m,sigma_north_mm,sigma_east_mm,sigma_down_mm,roll_deg,pitch_deg,"
         "yaw_deg,sigma_roll_arcsec,sigma_pitch_arcsec,sigma_yaw_arcsec,scale_ppm,sigma0,redundancy,targets,"
         "excluded,geometry,remarks\n";
  targets << "station,point,used,across_mm,up_mm,along_mm,w_across,w_up,w_along,redundancy_across,redundancy_up,"
             "redundancy_along,detectable_across_mm,detectable_up_mm,detectable_along_mm,point_test,reason\n";
  for (const auto& s : o.run.stations) {
    const auto g = o.frame.to_geodetic(s.position);
    const auto e = geodesy::to_euler(s.q_ms);
    const Eigen::Matrix<double, 7, 1> sigma = s.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    std::string remarks;
    for (const auto& r : s.geometry.remarks) remarks += (remarks.empty() ? "" : "; ") + r;
    stations << fmt::format(
        "{},{:.12f},{:.12f},{:.6f},{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},{},{},{"
        "},{},\"{}\"\n",
        s.name, g.latitude / units::deg, g.longitude / units::deg, g.height, sigma(0) * 1e3, sigma(1) * 1e3,
        sigma(2) * 1e3, e.roll / units::deg, e.pitch / units::deg, e.yaw / units::deg, sigma(3) / units::arcsec,
        sigma(4) / units::arcsec, sigma(5) / units::arcsec, (s.scale - 1.0) * 1e6, s.sigma0, s.redundancy,
        s.targets.size(), s.excluded.size(), to_string(s.geometry.grade), remarks);
    for (const auto& t : s.targets) {
      const Eigen::Vector3d r = t.residual * 1e3, d = t.detectable * 1e3;
      targets << fmt::format(
          "{},{},1,{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},\n",
          s.name, t.point, r.x(), r.y(), r.z(), t.normalized.x(), t.normalized.y(), t.normalized.z(), t.redundancy.x(),
          t.redundancy.y(), t.redundancy.z(), d.x(), d.y(), d.z(), t.point_test);
    }
    for (const auto& x : s.excluded) {
      targets << fmt::format("{},{},0,,,,,,,,,,,,,{:.2f},{}{}\n", s.name, x.point, x.test, to_string(x.reason),
                             x.is.empty() ? "" : ": " + x.is);
    }
  }
}

}  // namespace

Expected<PositioningRun> run_gnss(const fs::path& path, std::span<const std::string> overrides, const fs::path& output,
                                  Progress& progress, Log& log) {
  auto job = read_job<GnssJob>(path, overrides);
  if (!job) return tl::unexpected(job.error());
  auto solved = process_gnss(job->gnss, progress, log);
  if (!solved) return tl::unexpected(solved.error());
  auto report = open_report("gnss", path, output);
  if (!report) return tl::unexpected(report.error());
  for (const auto& [role, files] :
       {std::pair{"rover", &job->gnss.rover}, {"base", &job->gnss.base}, {"navigation", &job->gnss.navigation}}) {
    if (auto done = note_files(role, *files, report->run.inputs); !done) return tl::unexpected(done.error());
  }
  report->run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, *job); });
  if (auto done = io::write_gnss_csv(report->folder.path("gnss.csv"), solved->series); !done) {
    return tl::unexpected(done.error());
  }
  std::ofstream(report->folder.path("rtklib.conf")) << solved->configuration;
  std::size_t fixed = 0;
  for (const auto& s : solved->series) fixed += s.fix == sensors::FixType::fixed;
  const nlohmann::ordered_json summary{{"epochs", solved->epochs},
                                       {"positions", solved->series.size()},
                                       {"fixed", fixed},
                                       {"confirmed", solved->confirmed},
                                       {"doubted", solved->doubted}};
  std::string text = fmt::format("{} epochs, {} positions, {} fixed, {} confirmed by both directions, {} doubted\n",
                                 solved->epochs, solved->series.size(), fixed, solved->confirmed, solved->doubted);
  return close_report(*report, std::move(solved->record), summary, std::move(text));
}

Expected<PositioningRun> run_stationing(const fs::path& path, std::span<const std::string> overrides,
                                        const fs::path& output, Progress& progress, Log& log) {
  auto job = read_job<StationingJob>(path, overrides);
  if (!job) return tl::unexpected(job.error());
  auto o = process_stationing(job->total_station, progress, log);
  if (!o) return tl::unexpected(o.error());
  auto report = open_report("stationing", path, output);
  if (!report) return tl::unexpected(report.error());
  report->run.time_scale = job->total_station.time_scale;
  for (const auto& [role, files] :
       {std::pair{"readings", &job->total_station.readings}, {"control", &job->total_station.control}}) {
    if (auto done = note_files(role, *files, report->run.inputs); !done) return tl::unexpected(done.error());
  }
  report->run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, *job); });
  if (auto done = io::write_landmarks_csv(report->folder.path("landmarks.csv"), o->landmarks); !done) {
    return tl::unexpected(done.error());
  }
  write_stations(report->folder.folder(), *o);
  double sigma = 0.0;
  std::size_t excluded = 0;
  for (const auto& s : o->run.stations) {
    sigma = std::max(sigma, std::sqrt(s.covariance.diagonal().head<3>().maxCoeff()));
    excluded += s.excluded.size();
  }
  nlohmann::ordered_json summary{{"stations", o->run.stations.size()},
                                 {"failed", o->run.failed.size()},
                                 {"excluded", excluded},
                                 {"moved", o->run.moved.size()},
                                 {"largest_sigma_mm", sigma * 1e3}};
  std::string text =
      fmt::format("{} stations, {} failed, {} targets left out, {} moved control points, largest sigma {:.2f} mm\n",
                  o->run.stations.size(), o->run.failed.size(), excluded, o->run.moved.size(), sigma * 1e3);
  if (job->adjust) {
    job->network.tilt_sigma = job->total_station.options.tilt_sigma;
    job->network.significance = job->total_station.options.significance;
    auto n = stationing::adjust_network(o->reduced, o->network, job->total_station.instrument, job->network);
    if (!n) return tl::unexpected(n.error());
    if (auto done = write_network_points(report->folder.path("points.csv"), o->frame, *n); !done) {
      return tl::unexpected(done.error());
    }
    summary["network"] = nlohmann::ordered_json::parse(network_summary_json(*n));
    text += fmt::format("network: sigma0 {:.3f}, {} redundant observations\n", n->sigma0, n->redundancy);
  }
  return close_report(*report, std::move(o->record), summary, std::move(text));
}

namespace {
template <class Job>
void describe_defaults(ConfigVisitor& v) {
  Job job;
  describe(v, job);
}
Expected<std::vector<std::string>> check_gnss(const fs::path& path, std::span<const std::string> overrides) {
  const auto job = read_job<GnssJob>(path, overrides);
  if (!job) return tl::unexpected(job.error());
  const gnss_files::Workspace workspace;
  SilentProgress progress;
  const auto files = gnss_files::prepare(job->gnss, workspace, progress);
  if (!files) return tl::unexpected(files.error());
  if (auto good = gnss_files::check(job->gnss, *files); !good) return tl::unexpected(good.error());
  const auto span = gnss_files::span_of(files->rover);
  return std::vector{
      fmt::format("{} files of the rover, {} of the base, {} of navigation data", files->rover.size(),
                  files->base.size(), files->navigation.size()),
      fmt::format("rover: {} to {}", to_text(span.first, TimeScale::gps), to_text(span.last, TimeScale::gps))};
}
Expected<std::vector<std::string>> check_stationing(const fs::path& path, std::span<const std::string> overrides) {
  const auto job = read_job<StationingJob>(path, overrides);
  if (!job) return tl::unexpected(job.error());
  SilentProgress progress;
  SilentLog log;
  const auto o = process_stationing(job->total_station, progress, log);
  if (!o) return tl::unexpected(o.error());
  return std::vector<std::string>{
      fmt::format("{} stations, {} control points", o->run.stations.size(), o->network.points().size())};
}
}  // namespace

const JobKind gnss_job{"gnss", "Observations of satellites become positions of the antenna.",
                       describe_defaults<GnssJob>, check_gnss};
const JobKind stationing_job{"stationing", "Readings of a total station become positions of its stations.",
                             describe_defaults<StationingJob>, check_stationing};

}  // namespace versine::app
