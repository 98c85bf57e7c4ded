// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey_output.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "positioning/network_report.hpp"
#include "versine/app/landmark_residuals.hpp"
#include "versine/app/report.hpp"
#include "versine/core/units.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::app {

namespace {
using json = nlohmann::ordered_json;

/// Numbers of a run that a person asks for first.
json summary_of(const SurveyConfig& config, const SurveyResult& result, const std::string& crs) {
  const auto& estimate = result.estimate;
  const auto& track = estimate.solution.smoothed;
  json out;
  if (!config.title.empty()) out["title"] = config.title;
  out["points"] = track.size();
  out["duration_s"] = (track.back().time - track.front().time).seconds();
  double length = 0.0, worst_h = 0.0, worst_v = 0.0, sum_h = 0.0;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const auto& p = track[i];
    if (i > 0 && p.segment == track[i - 1].segment) {
      length += 0.5 * (p.v_eb_n + track[i - 1].v_eb_n).norm() * (p.time - track[i - 1].time).seconds();
    }
    const double h2 = p.position_covariance.xx + p.position_covariance.yy;
    sum_h += h2;
    worst_h = std::max(worst_h, std::sqrt(h2));
    worst_v = std::max(worst_v, std::sqrt(double{p.position_covariance.zz}));
  }
  out["length_m"] = length;
  out["crs"] = crs;
  out["sigma_horizontal_rms_m"] = std::sqrt(sum_h / static_cast<double>(track.size()));
  out["sigma_horizontal_max_m"] = worst_h;
  out["sigma_vertical_max_m"] = worst_v;
  for (const auto& s : estimate.segments) {
    const geodesy::Euler e =
        geodesy::to_euler(s.fine_attitude ? geodesy::to_quaternion(*s.fine_attitude) : s.alignment.q_nb);
    const Eigen::Vector3d sigma = s.fine_sigma.value_or(s.alignment.sigma);
    out["segments"].push_back({{"from_s", s.from.seconds()},
                               {"to_s", s.to.seconds()},
                               {"alignment", s.alignment.method},
                               {"roll_deg", e.roll / units::deg},
                               {"pitch_deg", e.pitch / units::deg},
                               {"heading_deg", e.yaw / units::deg},
                               {"sigma_level_deg", sigma.head<2>().maxCoeff() / units::deg},
                               {"sigma_heading_deg", sigma.z() / units::deg}});
  }
  for (const auto& s : estimate.statistics) {
    out["innovations"].push_back({{"sensor", s.sensor},
                                  {"used", s.used},
                                  {"rejected", s.rejected},
                                  {"mean_nis_per_row", s.mean_nis_per_row},
                                  {"lower", s.lower},
                                  {"upper", s.upper}});
  }
  out["standstills"] = json::parse(standstills_json(estimate.standstills, track.front().time));
  const auto& errors = estimate.solution.sensor_errors;
  if (!errors.empty()) {
    for (std::size_t i = 0; i < estimate.solution.error_names.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      out["sensor_errors_at_end"][estimate.solution.error_names[i]] = {{"value", errors.back().value(k)},
                                                                       {"sigma", errors.back().sigma(k)}};
    }
  }
  if (result.control) out["network"] = json::parse(network_summary_json(result.control->network));
  if (result.earth_rate) {
    const inertial::EarthRate& e = *result.earth_rate;
    out["earth_rate"] = {{"total_degph", e.omega_ib_b.norm() / units::deg_per_hour},
                         {"horizontal_degph", e.horizontal / units::deg_per_hour},
                         {"vertical_degph", e.vertical / units::deg_per_hour},
                         {"sigma_degph", e.sigma / units::deg_per_hour}};
  }
  if (result.geometry) out["geometry"] = json::parse(geometry_summary_json(*result.geometry));
  if (result.withheld) {
    const WithheldErrors& w = *result.withheld;
    out["withheld"] = {{"window_s", config.withhold.window},
                       {"windows", w.windows},
                       {"epochs", w.count},
                       {"rms_horizontal_m", w.rms_horizontal},
                       {"p95_horizontal_m", w.p95_horizontal},
                       {"max_horizontal_m", w.max_horizontal},
                       {"rms_vertical_m", w.rms_vertical},
                       {"coverage95", w.coverage}};
  }
  return out;
}

std::string text_of(const SurveyResult& result, const json& s) {
  std::string text = fmt::format("{:.1f} s, {:.1f} m, {} points; sigma horizontal {:.4g} m (max {:.4g} m)\n",
                                 s["duration_s"].get<double>(), s["length_m"].get<double>(), s["points"].get<int>(),
                                 s["sigma_horizontal_rms_m"].get<double>(), s["sigma_horizontal_max_m"].get<double>());
  for (const auto& i : s.value("innovations", json::array())) {
    text += fmt::format("  {}: {} used, {} rejected, mean NIS {:.2f} ({:.2f} to {:.2f})\n",
                        i["sensor"].get<std::string>(), i["used"].get<int>(), i["rejected"].get<int>(),
                        i["mean_nis_per_row"].get<double>(), i["lower"].get<double>(), i["upper"].get<double>());
  }
  if (result.earth_rate) {
    text += fmt::format("  Earth rate seen while standing: {:.3f} deg/h, sigma {:.3f}\n",
                        result.earth_rate->omega_ib_b.norm() / units::deg_per_hour,
                        result.earth_rate->sigma / units::deg_per_hour);
  }
  for (const Finding& f : result.input.record.findings) {
    text += f.count > 0 ? fmt::format("  {}: {} x {}, {}\n", f.sensor, f.count, f.kind, to_string(f.action))
                        : fmt::format("  {}: {}\n", f.kind, f.detail);
  }
  for (const auto& warning : result.warnings) text += "  warning: " + warning + "\n";
  if (result.geometry) text += geometry_summary_text(*result.geometry);
  if (s.contains("withheld")) {
    const auto& w = s["withheld"];
    text += fmt::format(
        "  withheld {:g} s: {} windows, horizontal RMS {:.3f} m, 95 % {:.3f} m, max {:.3f} m, "
        "coverage {:.1f} %\n",
        w["window_s"].get<double>(), w["windows"].get<int>(), w["rms_horizontal_m"].get<double>(),
        w["p95_horizontal_m"].get<double>(), w["max_horizontal_m"].get<double>(),
        100.0 * w["coverage95"].get<double>());
  }
  return text;
}

Expected<geodesy::Projection> project_crs(const SurveyConfig& config, const geodesy::Trajectory& track) {
  if (config.output.crs.empty()) return geodesy::Projection::utm(track.front().position);
  auto projection = geodesy::Projection::create(config.output.crs);
  if (!projection) projection.error().field = "output.crs";
  return projection;
}

}  // namespace

std::string standstills_json(std::span<const inertial::Interval> standstills, Time begin) {
  double total = 0.0, longest = 0.0, first = 0.0;
  for (const inertial::Interval& s : standstills) {
    total += s.seconds();
    longest = std::max(longest, s.seconds());
    if ((s.from - begin).seconds() < 1.0) first = s.seconds();
  }
  return json{{"count", standstills.size()}, {"total_s", total}, {"longest_s", longest}, {"first_s", first}}.dump();
}

Expected<SurveyRun> write_survey(const SurveyConfig& config, SurveyResult& result, io::Run run,
                                 io::ResultFolder& folder, Progress& progress) {
  auto& solution = result.estimate.solution;
  if (solution.smoothed.empty()) {
    return fail({.found = "a solution without any point",
                 .expected = "at least one second of IMU data",
                 .advice = "'versine info' on the IMU's file shows what it holds"});
  }
  const auto projection = project_crs(config, solution.smoothed);
  if (!projection) return tl::unexpected(projection.error());
  io::TrajectoryOutput output{.projection = &*projection};
  // Dead reckoning delivers every IMU sample; the aided INS has thinned its trajectory already.
  if (config.method == SurveyMethod::landmark && config.estimator.output_rate > 0.0) {
    output.interval = Duration::from_seconds(1.0 / config.estimator.output_rate);
  }

  const auto started = std::chrono::steady_clock::now();
  std::vector<std::function<Expected<void>()>> writers;
  if (config.output.csv) {
    writers.emplace_back(
        [&] { return io::write_trajectory_csv(folder.path("trajectory.csv"), solution.smoothed, output); });
    if (!solution.forward.empty()) {
      writers.emplace_back(
          [&] { return io::write_trajectory_csv(folder.path("forward.csv"), solution.forward, output); });
    }
    if (result.estimate.dead_reckoned) {
      writers.emplace_back([&] {
        return io::write_trajectory_csv(folder.path("dead_reckoning.csv"), *result.estimate.dead_reckoned, output);
      });
    }
  }
  if (config.output.hdf5) {
    writers.emplace_back([&] { return io::write_solution_hdf5(folder.path("trajectory.h5"), solution, output); });
  }
  if (config.output.innovations) {
    writers.emplace_back([&] {
      return io::write_innovations_csv(folder.path("innovations.csv"), solution.innovations, solution.smoothed.scale);
    });
  }
  if (!result.input.landmarks.empty()) {
    writers.emplace_back([&] {
      const track::Geometry* geometry = result.geometry ? &result.geometry->geometry : nullptr;
      return write_landmark_residuals(
          folder.path("landmarks.csv"),
          landmark_residuals(result.input.landmarks, solution, config.estimator.landmark_lever.l_b, geometry),
          geometry);
    });
  }
  if (result.geometry) {
    writers.emplace_back([&] { return write_track_geometry(config.geometry, *result.geometry, folder, progress); });
  }
  if (result.control) {
    writers.emplace_back([&] {
      return write_network_points(folder.path("control_points.csv"), result.input.total_station->frame,
                                  result.control->network);
    });
  }
  RunRecord record = std::move(result.input.record);
  record.append(solution.record);
  if (result.control) record.append(result.control->record);
  result.warnings = record.warnings;  // the geometry's summary tells its own
  if (result.geometry) record.append(result.geometry->geometry.record);
  writers.emplace_back([&] {
    return io::write_rejections_csv(folder.path("rejections.csv"), record.rejections, solution.smoothed.scale);
  });
  for (std::size_t i = 0; i < writers.size(); ++i) {
    progress.report("writing", static_cast<double>(i) / static_cast<double>(writers.size()));
    if (progress.cancelled()) return fail({.found = "cancelled"});
    if (auto done = writers[i](); !done) return tl::unexpected(done.error());
  }
  result.timings_s.emplace_back("write",
                                std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count());

  result.input.record = record;
  const json summary = summary_of(config, result, projection->definition());
  SurveyConfig described = config;
  run.time_scale = solution.smoothed.scale;
  run.inputs = result.input.files;
  if (result.geometry) {
    run.inputs.insert(run.inputs.end(), result.geometry->files.begin(), result.geometry->files.end());
  }
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, described); });
  run.timings_s = result.timings_s;
  run.results_json = summary.dump();
  run.record = std::move(record);
  if (auto done = io::write_run_json(folder.path("run.json"), run); !done) return tl::unexpected(done.error());
  if (auto done = write_job_report(config.report, folder.folder(), folder.target()); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = folder.commit(); !done) return tl::unexpected(done.error());
  progress.report("writing", 1.0);
  return SurveyRun{folder.target(), summary.dump(2), text_of(result, summary)};
}

}  // namespace versine::app
