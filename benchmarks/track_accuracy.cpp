// SPDX-License-Identifier: Apache-2.0
// Simulated surveys through aided INS and track geometry against the true rails: a Markdown table, one group of columns
// for each scenario.
// versine_track_accuracy SEEDS SCENARIO.toml ... [key=value ...]   (keys of the survey job; "sim:key=value": of the
// scenario)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "versine/app/simulate.hpp"
#include "versine/app/survey_config.hpp"
#include "versine/core/units.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"
#include "versine/track/butterworth.hpp"
#include "versine/track/compute.hpp"
#include "versine/track/odometry.hpp"
#include "versine/track/resampling.hpp"
#include "versine/track/versine.hpp"

using namespace versine;

namespace {

/// Errors of one quantity over all seeds, with their sigmas.
class Errors {
 public:
  void add(double error, double sigma) {
    if (!std::isfinite(error)) return;
    errors_.push_back(std::abs(error));
    if (!(sigma > 0)) return;
    ++known_;
    ++known_in_seed_;
    inside_in_seed_ += std::abs(error) < 1.96 * sigma;
    variance_ += sigma * sigma;
  }
  void end_seed() {
    if (known_in_seed_ > 0) coverage_.push_back(double(inside_in_seed_) / double(known_in_seed_));
    known_in_seed_ = inside_in_seed_ = 0;
  }
  [[nodiscard]] bool empty() const { return errors_.empty(); }
  [[nodiscard]] double rms() const {
    double s = 0;
    for (const double e : errors_) s += e * e;
    return std::sqrt(s / double(errors_.size()));
  }
  [[nodiscard]] double p95() const {
    std::vector<double> a = errors_;
    const auto at = a.begin() + static_cast<std::ptrdiff_t>(0.95 * double(a.size() - 1));
    std::nth_element(a.begin(), at, a.end());
    return *at;
  }
  /// RMS of the sigmas: what the covariance says that can be reached.
  [[nodiscard]] double bound() const { return known_ > 0 ? std::sqrt(variance_ / double(known_)) : std::nan(""); }
  /// Share inside 1.96 sigma and its standard error: errors of one seed are alike, so seeds count, not points.
  [[nodiscard]] std::string coverage() const {
    if (coverage_.empty()) return "-";
    double mean = 0, square = 0;
    for (const double c : coverage_) mean += c / double(coverage_.size());
    for (const double c : coverage_) square += (c - mean) * (c - mean);
    const double n = double(coverage_.size());
    return fmt::format("{:.1f} ± {:.1f}", 100 * mean, n > 1 ? 100 * std::sqrt(square / (n - 1) / n) : 0.0);
  }

 private:
  std::vector<double> errors_, coverage_;
  std::size_t known_ = 0, known_in_seed_ = 0, inside_in_seed_ = 0;
  double variance_ = 0;
};

enum Row {
  lateral,
  vertical,
  gauge,
  cross_level,
  twist,
  check30_lateral,
  check30_vertical,
  check300_lateral,
  check300_vertical,
  versine_lateral,
  versine_vertical,
  alignment_d1,
  level_d1,
  alignment_d2,
  level_d2,
  runs_lateral,
  runs_vertical,
  mileage,
  wheels,
  wheels_calibrated,
  rows
};

struct Quantity {
  const char* name;
  const char* wanted;
  bool largest;  ///< 95 % of the absolute values, not the RMS
  double scale = 1e3;
};
constexpr Quantity quantities[rows] = {
    {"rails, lateral", "0.75 / 0.5 / cm", false},
    {"rails, vertical", "0.75 / 0.5 / cm", false},
    {"gauge", "0.15", false},
    {"cross level", "0.15", false},
    {"twist 3 m, mm/m", "", false},
    {"30 m check, lateral", "", false},
    {"30 m check, vertical", "", false},
    {"300 m check, lateral", "", false},
    {"300 m check, vertical", "", false},
    {"versine 10 m, lateral", "", false},
    {"versine 10 m, vertical", "", false},
    {"alignment D1", "", false},
    {"level D1", "", false},
    {"alignment D2", "", false},
    {"level D2", "", false},
    {"30 m check between runs, lateral, 95 %", "0.3", true},
    {"30 m check between runs, vertical, 95 %", "0.3", true},
    {"mileage of the result, 95 %, %", "0.05", true, 1e2},
    {"odometers as delivered, 95 %, %", "0.05", true, 1e2},
    {"odometers with the trajectory's scale, 95 %, %", "0.05", true, 1e2},
};

using Table = std::vector<Errors>;

/// Errors of both rails on the grid of the geometry.
struct RailErrors {
  std::vector<double> lateral[2], vertical[2], gauge, cross_level;
};

RailErrors against_truth(const track::Geometry& g, const simulation::RailTruth& rails,
                         const geodesy::Projection& projection, const design::Alignment& line) {
  std::vector<double> e[2], n[2], h[2];
  for (std::size_t i = 0; i < rails.distance.size(); ++i) {
    const geodesy::MapPoint p[2] = {projection.forward(rails.left[i]), projection.forward(rails.right[i])};
    const double middle = 0.5 * (p[0].height + p[1].height);
    for (int k = 0; k < 2; ++k) {
      e[k].push_back(p[k].easting), n[k].push_back(p[k].northing);
      // The truth is at the gauge corners; heights of the result are at the head centres.
      h[k].push_back(middle + (k == 0 ? 0.5 : -0.5) * rails.cross_level[i]);
    }
  }
  const auto on = [&](const std::vector<double>& x) { return track::interpolated(rails.distance, x, g.mileage, 1.0); };
  const auto minus = [&](const std::string& column, const std::vector<double>& truth) {
    std::vector<double> out = g.at(column).value;
    const auto t = on(truth);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= t[i];
    return out;
  };
  RailErrors out;
  for (int k = 0; k < 2; ++k) {
    const std::string rail = k == 0 ? "left" : "right";
    const auto de = minus("easting_" + rail, e[k]), dn = minus("northing_" + rail, n[k]);
    out.vertical[k] = minus("height_" + rail, h[k]);
    for (std::size_t i = 0; i < g.size(); ++i) {
      const double heading = line.at(g.mileage[i]).heading;
      out.lateral[k].push_back(de[i] * std::cos(heading) - dn[i] * std::sin(heading));
    }
  }
  out.gauge = minus("gauge", rails.gauge);
  out.cross_level = minus("cross_level", rails.cross_level);
  return out;
}

/// Every parameter is linear in the rails' places: its error is the parameter of their errors.
void add_parameters(const track::Geometry& g, const RailErrors& e, std::size_t margin, Table& out) {
  const std::size_t n = g.size();
  const auto add = [&](Row row, const std::vector<double>& error, const std::string& column) {
    const auto& sigma = g.at(column).sigma;
    for (std::size_t i = margin; i + margin < n; ++i) out[row].add(error[i], sigma[i]);
  };
  add(gauge, e.gauge, "gauge");
  add(cross_level, e.cross_level, "cross_level");
  const auto back = static_cast<std::size_t>(3.0 / g.step);
  std::vector<double> difference(n, std::nan(""));
  for (std::size_t i = back; i < n; ++i) difference[i] = (e.cross_level[i] - e.cross_level[i - back]) / 3.0;
  add(twist, difference, "twist_3m");
  for (int k = 0; k < 2; ++k) {
    const std::string rail = k == 0 ? "left" : "right";
    add(lateral, e.lateral[k], "easting_" + rail);
    add(vertical, e.vertical[k], "height_" + rail);
    for (const bool across : {true, false}) {
      const std::vector<double>& error = across ? e.lateral[k] : e.vertical[k];
      const auto name = [&](const char* stem, const char* end) {
        return fmt::format("{}_{}_{}{}", stem, across ? "lateral" : "vertical", rail, end);
      };
      add(across ? check30_lateral : check30_vertical, track::chord_check(error, g.step, {"30m", 30.0, 15.0, 5.0}),
          name("check_30m", ""));
      add(across ? check300_lateral : check300_vertical,
          track::chord_check(error, g.step, {"300m", 300.0, 15.0, 150.0}), name("check_300m", ""));
      add(across ? versine_lateral : versine_vertical, track::scalar_versines(error, g.step, {10.0, 5.0}),
          name("versine", "_10m"));
      const std::string stem = (across ? "alignment_" : "level_") + rail;
      add(across ? alignment_d1 : level_d1, track::filter_both_ways(track::band_pass(3.0, 25.0, g.step, 4), error, 300),
          stem + "_d1");
      add(across ? alignment_d2 : level_d2,
          track::filter_both_ways(track::band_pass(25.0, 70.0, g.step, 4), error, 840), stem + "_d2");
    }
  }
}

/// What mileage gains or loses over the run, in parts of its length.
void add_mileage(const track::Geometry& g, const simulation::SimulatedRecording& r, const geodesy::Trajectory& smoothed,
                 const Eigen::Vector3d& forward, std::size_t margin, Table& out) {
  const auto& p = r.truth.progress;
  const auto true_at = [&](Time t) {
    const auto b = std::lower_bound(p.begin() + 1, p.end() - 1, t, [](const auto& x, Time u) { return x.time < u; });
    const auto a = b - 1;
    return a->distance + (b->distance - a->distance) * ((t - a->time).seconds() / (b->time - a->time).seconds());
  };
  const std::size_t first = margin, last = g.size() - 1 - margin;
  const double truth = true_at(g.time[last]) - true_at(g.time[first]);
  out[mileage].add((g.mileage[last] - g.mileage[first] - truth) / truth, 0);
  if (r.odometers.empty()) return;
  for (const bool calibrated : {false, true}) {
    RunRecord record;
    track::OdometerOptions options;
    options.forward = forward;
    if (!calibrated) options.scale_sigma = 0;
    const auto o = track::combine_odometers(r.odometers, &smoothed, options, record).odometer;
    const double way = track::distance_at(o, g.time[last]) - track::distance_at(o, g.time[first]);
    out[calibrated ? wheels_calibrated : wheels].add((std::abs(way) - std::abs(truth)) / std::abs(truth), 0);
  }
}

struct Settings {
  int seeds = 20;
  std::vector<std::string> job, simulated;
};

Expected<void> survey_once(const app::SimulateConfig& config, const std::string& path,
                           std::shared_ptr<const simulation::World> world, const Settings& settings, int seed,
                           Table& out, std::vector<std::vector<double>>& checks) {
  auto r = simulation::observe(*world, static_cast<std::uint64_t>(1000 + seed));
  app::SurveyConfig job;
  if (auto done = app::parse_config(
          app::survey_job_for(config, r), std::filesystem::absolute(path),
          [&](app::ConfigVisitor& v) { describe(v, job); }, settings.job);
      !done) {
    return done;
  }
  job.estimator.imu_errors = *job.imu_errors.errors();
  job.estimator.chain_rate = 1.0;
  job.estimator.output_rate = 50.0;  // as of a survey with geometry
  job.geometry.trolley.mounting = job.estimator.mounting;
  fusion::AidedInsInput in;
  in.imu = std::move(r.imu);
  in.gnss = r.gnss;
  if (!r.odometers.empty()) in.odometer = r.odometers.front();
  in.landmarks.samples = r.landmarks;
  SilentProgress progress;
  SilentLog log;
  const auto solved = fusion::run_aided_ins(in, job.estimator, progress, log);
  if (!solved) return tl::unexpected(solved.error());
  const design::Alignment& line = config.scenario.track.alignment;
  track::GeometryInput input;
  input.trajectory = &solved->solution.smoothed;
  input.chain = &solved->solution.chain;
  input.gauge = r.gauge;
  input.design = &line;
  input.trolley = job.geometry.trolley;
  input.projection = *geodesy::Projection::create(line.crs);
  auto options = job.geometry.options;
  options.height_reference = config.scenario.track.cant_pivot == simulation::TrackModel::CantPivot::axis
                                 ? track::HeightReference::axis
                                 : track::HeightReference::low_rail;
  const auto g = track::compute_geometry(input, options, progress);
  if (!g) return tl::unexpected(g.error());
  const auto margin = static_cast<std::size_t>(20.0 / g->step);
  const RailErrors errors = against_truth(*g, r.truth.rails, *input.projection, line);
  add_parameters(*g, errors, margin, out);
  add_mileage(*g, r, solved->solution.smoothed, geodesy::to_matrix(input.trolley.mounting).transpose().col(0), margin,
              out);
  // The difference of two runs' checks is that of their errors; all seeds are on one grid.
  std::vector<std::vector<double>> own = {track::chord_check(errors.lateral[0], g->step, {"30m", 30.0, 15.0, 5.0}),
                                          track::chord_check(errors.vertical[0], g->step, {"30m", 30.0, 15.0, 5.0})};
  for (std::size_t k = 0; k < checks.size(); ++k) {
    for (std::size_t i = margin; i + margin < std::min(own[k].size(), checks[k].size()); ++i) {
      out[k == 0 ? runs_lateral : runs_vertical].add(own[k][i] - checks[k][i], 0);
    }
  }
  checks = std::move(own);
  for (Errors& e : out) e.end_seed();
  return {};
}

Expected<Table> study(const std::string& path, const Settings& settings, std::string& title) {
  const auto config = app::read_simulate_config(path, settings.simulated);
  if (!config) return tl::unexpected(config.error());
  title = config->title;
  const auto world = simulation::prepare(config->scenario);
  if (!world) return tl::unexpected(world.error());
  Table table(rows);
  std::vector<std::vector<double>> checks;
  for (int seed = 0; seed < settings.seeds; ++seed) {
    if (auto done = survey_once(*config, path, *world, settings, seed, table, checks); !done) {
      return tl::unexpected(done.error());
    }
    std::fprintf(stderr, "%s: seed %d of %d\r", title.c_str(), seed + 1, settings.seeds);
  }
  std::fprintf(stderr, "\n");
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::vector<std::string> scenarios;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (i == 1 && text.find_first_not_of("0123456789") == std::string::npos)
      settings.seeds = std::atoi(argv[i]);
    else if (text.starts_with("sim:"))
      settings.simulated.push_back(text.substr(4));
    else if (text.find('=') != std::string::npos)
      settings.job.push_back(text);
    else
      scenarios.push_back(text);
  }
  if (scenarios.empty()) return fmt::print("versine_track_accuracy [SEEDS] SCENARIO.toml ... [key=value ...]\n"), 2;
  std::vector<Table> tables;
  std::string head = "| quantity, RMS in mm | wanted |", line = "|---|---|";
  for (const std::string& path : scenarios) {
    std::string title;
    auto table = study(path, settings, title);
    if (!table) return fmt::print("{}\n", table.error().message()), 1;
    tables.push_back(std::move(*table));
    head += fmt::format(" {} | bound | inside, % |", title);
    line += "---|---|---|";
  }
  fmt::print("{} seeds\n\n{}\n{}\n", settings.seeds, head, line);
  for (int k = 0; k < rows; ++k) {
    const Quantity& q = quantities[k];
    std::string text = fmt::format("| {} | {} |", q.name, q.wanted);
    for (const Table& t : tables) {
      const Errors& e = t[static_cast<std::size_t>(k)];
      if (e.empty()) {
        text += " - | - | - |";
        continue;
      }
      const double bound = e.bound();
      text += fmt::format(" {:.3f} | {} | {} |", q.scale * (q.largest ? e.p95() : e.rms()),
                          std::isfinite(bound) ? fmt::format("{:.3f}", q.scale * bound) : "-", e.coverage());
    }
    fmt::print("{}\n", text);
  }
  return 0;
}
