// SPDX-License-Identifier: Apache-2.0
// Simulated surveys through aided INS and track geometry against the true rails, one row of a Markdown table.
// versine_track_accuracy SCENARIO.toml [SEEDS] [key=value ...]   (keys of the survey job)
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "versine/app/simulate.hpp"
#include "versine/app/survey_config.hpp"
#include "versine/core/units.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"
#include "versine/track/compute.hpp"
#include "versine/track/odometry.hpp"
#include "versine/track/resampling.hpp"
#include "versine/track/versine.hpp"

using namespace versine;

namespace {

/// Errors of one quantity, with their sigmas.
struct Errors {
  std::vector<double> error;
  double inside = 0, with_sigma = 0, variance = 0;
  void add(double e, double sigma) {
    if (!std::isfinite(e)) return;
    error.push_back(e);
    if (!(sigma > 0)) return;
    with_sigma += 1;
    inside += std::abs(e) < 1.96 * sigma;
    variance += sigma * sigma;
  }
  [[nodiscard]] double rms() const {
    double s = 0;
    for (const double e : error) s += e * e;
    return std::sqrt(s / double(std::max<std::size_t>(1, error.size())));
  }
  [[nodiscard]] double p95() const {
    if (error.empty()) return 0;
    std::vector<double> a;
    for (const double e : error) a.push_back(std::abs(e));
    const auto at = a.begin() + static_cast<std::ptrdiff_t>(0.95 * double(a.size() - 1));
    std::nth_element(a.begin(), at, a.end());
    return *at;
  }
};

struct Table {
  Errors lateral, vertical, gauge, cross_level, twist, check30_lateral, check30_vertical, repeat_lateral,
      repeat_vertical, mileage;
};

/// The true rails on the grid, as deviations that the geometry's columns should show.
struct Truth {
  std::vector<double> easting[2], northing[2], height, gauge, cross_level;
};

Truth truth_on(const track::Geometry& g, const simulation::RailTruth& rails, const geodesy::Projection& projection) {
  std::vector<double> e[2], n[2], h;
  for (std::size_t i = 0; i < rails.distance.size(); ++i) {
    const auto l = projection.forward(rails.left[i]), r = projection.forward(rails.right[i]);
    e[0].push_back(l.easting), n[0].push_back(l.northing), e[1].push_back(r.easting), n[1].push_back(r.northing);
    h.push_back(0.5 * (l.height + r.height));
  }
  Truth t;
  const auto on = [&](const std::vector<double>& x) { return track::interpolated(rails.distance, x, g.mileage, 1.0); };
  for (int k = 0; k < 2; ++k) t.easting[k] = on(e[k]), t.northing[k] = on(n[k]);
  t.height = on(h);
  t.gauge = on(rails.gauge);
  t.cross_level = on(rails.cross_level);
  return t;
}

void compare(const track::Geometry& g, const Truth& t, const design::Alignment& line, std::size_t margin, Table& out,
             std::vector<std::vector<double>>& checks) {
  const std::size_t n = g.size();
  const char* names[2] = {"left", "right"};
  const auto &gauge = g.at("gauge"), &level = g.at("cross_level"), &twist = g.at("twist_3m"),
             &height = g.at("height_axis");
  std::vector<double> true_deviation[2], true_height(n);
  for (int k = 0; k < 2; ++k) {
    const auto &e = g.at(std::string("easting_") + names[k]), &u = g.at(std::string("northing_") + names[k]);
    const auto& deviation = g.at(std::string("deviation_lateral_") + names[k]);
    for (std::size_t i = 0; i < n; ++i) {
      const double heading = line.at(g.mileage[i]).heading;
      const double d =
          (e.value[i] - t.easting[k][i]) * std::cos(heading) - (u.value[i] - t.northing[k][i]) * std::sin(heading);
      true_deviation[k].push_back(deviation.value[i] - d);
      if (i >= margin && i + margin < n) out.lateral.add(d, e.sigma[i]);
    }
  }
  std::vector<double> true_vertical(n);
  const auto& vertical = g.at("deviation_vertical_left");
  for (std::size_t i = 0; i < n; ++i) {
    const double dh = height.value[i] - t.height[i], dc = level.value[i] - t.cross_level[i];
    true_vertical[i] = vertical.value[i] - (dh + 0.5 * dc);
    if (i < margin || i + margin >= n) continue;
    out.vertical.add(dh + 0.5 * dc, g.at("height_left").sigma[i]);
    out.vertical.add(dh - 0.5 * dc, g.at("height_right").sigma[i]);
    out.gauge.add(gauge.value[i] - t.gauge[i], gauge.sigma[i]);
    out.cross_level.add(dc, level.sigma[i]);
    const std::size_t back = static_cast<std::size_t>(3.0 / g.step);
    out.twist.add(twist.value[i] - (t.cross_level[i] - t.cross_level[i - back]) / 3.0, twist.sigma[i]);
  }
  const track::ChordCheck c{"30m", 30.0, 15.0, 5.0};
  const auto lateral_truth = track::chord_check(true_deviation[0], g.step, c);
  const auto vertical_truth = track::chord_check(true_vertical, g.step, c);
  const auto &a = g.at("check_30m_lateral_left"), &b = g.at("check_30m_vertical_left");
  std::vector<double> difference[2] = {std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    difference[0][i] = a.value[i] - lateral_truth[i];
    difference[1][i] = b.value[i] - vertical_truth[i];
    if (i < margin || i + margin >= n) continue;
    out.check30_lateral.add(difference[0][i], a.sigma[i]);
    out.check30_vertical.add(difference[1][i], b.sigma[i]);
  }
  checks.push_back(std::move(difference[0]));
  checks.push_back(std::move(difference[1]));
}

void print(const char* name, const Errors& e, double scale = 1e3) {
  std::printf("| %s | %.3f | %.3f | ", name, scale * e.rms(), scale * e.p95());
  if (e.with_sigma > 0) {
    std::printf("%.3f | %.1f %% |\n", scale * std::sqrt(e.variance / e.with_sigma), 100.0 * e.inside / e.with_sigma);
  } else {
    std::printf("- | - |\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::printf("versine_track_accuracy SCENARIO.toml [SEEDS] [key=value ...]\n"), 2;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 20;
  std::vector<std::string> overrides, simulated;
  for (int i = 3; i < argc; ++i) {
    const std::string text = argv[i];
    if (text.starts_with("sim:"))
      simulated.push_back(text.substr(4));
    else
      overrides.push_back(text);
  }
  const auto config = app::read_simulate_config(argv[1], simulated);
  if (!config) return std::printf("%s\n", config.error().message().c_str()), 2;
  const auto world = simulation::prepare(config->scenario);
  if (!world) return std::printf("%s\n", world.error().message().c_str()), 2;
  Table table;
  SilentProgress progress;
  SilentLog log;
  std::vector<std::vector<double>> checks;  // lateral and vertical of each seed
  std::vector<double> first;
  for (int seed = 0; seed < seeds; ++seed) {
    auto r = simulation::observe(**world, static_cast<std::uint64_t>(1000 + seed));
    app::SurveyConfig job;
    const std::string text = app::survey_job_for(*config, r);
    if (auto done = app::parse_config(
            text, std::filesystem::absolute(argv[1]), [&](app::ConfigVisitor& v) { describe(v, job); }, overrides);
        !done) {
      return std::printf("%s\n", done.error().message().c_str()), 2;
    }
    job.estimator.imu_errors = *job.imu_errors.errors();
    job.estimator.chain_rate = 1.0;
    job.geometry.trolley.mounting = job.estimator.mounting;
    fusion::AidedInsInput in;
    in.imu = std::move(r.imu);
    in.gnss = r.gnss;
    if (!r.odometers.empty()) in.odometer = r.odometers.front();
    in.landmarks.samples = r.landmarks;
    const auto solved = fusion::run_aided_ins(in, job.estimator, progress, log);
    if (!solved) return std::printf("%s\n", solved.error().message().c_str()), 1;
    track::GeometryInput input;
    input.trajectory = &solved->solution.smoothed;
    input.chain = &solved->solution.chain;
    input.gauge = r.gauge;
    input.design = &config->scenario.track.alignment;
    input.trolley = job.geometry.trolley;
    input.projection = *geodesy::Projection::create(config->scenario.track.alignment.crs);
    auto options = job.geometry.options;
    options.height_reference = config->scenario.track.cant_pivot == simulation::TrackModel::CantPivot::axis
                                   ? track::HeightReference::axis
                                   : track::HeightReference::low_rail;
    const auto g = track::compute_geometry(input, options, progress);
    if (!g) return std::printf("%s\n", g.error().message().c_str()), 1;
    const auto t = truth_on(*g, r.truth.rails, *input.projection);
    // All seeds on one grid, whatever their first point.
    if (first.empty()) first = {g->mileage.front(), double(g->size())};
    compare(*g, t, config->scenario.track.alignment, static_cast<std::size_t>(20.0 / g->step), table, checks);
    if (seed > 0) {
      for (int k = 0; k < 2; ++k) {
        const auto &a = checks[checks.size() - 4 + static_cast<std::size_t>(k)],
                   &b = checks[checks.size() - 2 + static_cast<std::size_t>(k)];
        for (std::size_t i = 120; i + 120 < std::min(a.size(), b.size()); ++i) {
          (k == 0 ? table.repeat_lateral : table.repeat_vertical).add(a[i] - b[i], 0);
        }
      }
    }
    if (!r.odometers.empty()) {
      RunRecord record;
      const auto o = track::combine_odometers(r.odometers, &solved->solution.smoothed, {}, record);
      const double truth = r.truth.progress.back().distance - r.truth.progress.front().distance;
      table.mileage.add((std::abs(o.back().distance) - std::abs(truth)) / std::abs(truth), 0);
    }
    std::fprintf(stderr, "seed %d of %d\r", seed + 1, seeds);
  }
  std::printf(
      "\n%s, %d seeds\n\n| quantity | RMS, mm | 95 %%, mm | own sigma, mm | inside 1.96 sigma "
      "|\n|---|---|---|---|---|\n",
      config->title.c_str(), seeds);
  print("rails, lateral", table.lateral);
  print("rails, vertical", table.vertical);
  print("gauge", table.gauge);
  print("cross level", table.cross_level);
  print("twist 3 m, mm/m", table.twist);
  print("30 m check, lateral", table.check30_lateral);
  print("30 m check, vertical", table.check30_vertical);
  print("30 m check between runs, lateral", table.repeat_lateral);
  print("30 m check between runs, vertical", table.repeat_vertical);
  print("mileage of odometers, %", table.mileage, 1e2);
  return 0;
}
