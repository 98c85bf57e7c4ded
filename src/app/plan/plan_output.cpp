// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "versine/app/plan.hpp"
#include "versine/core/units.hpp"
#include "versine/report/plan_report.hpp"

namespace versine::app {

namespace {

using namespace units;

Expected<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file << text && file.flush()) return {};
  return fail({.file = path.string(),
               .found = "the file could not be written",
               .expected = "a folder that can be written and room on the disk",
               .advice = "free some space, or choose another folder with --output"});
}

std::string profile_csv(const std::vector<fusion::ProfilePoint>& profile) {
  std::string csv = "distance_m,lateral_sigma_mm,vertical_sigma_mm,longitudinal_sigma_mm\n";
  for (const auto& p : profile) {
    csv += fmt::format("{:.3f},{:.6f},{:.6f},{:.6f}\n", p.distance, p.sigma.lateral / mm, p.sigma.vertical / mm,
                       p.sigma.longitudinal / mm);
  }
  return csv;
}

std::string map_csv(const fusion::SigmaMap& map, const char* header, double x_unit, double y_unit) {
  std::string csv = fmt::format("{},sigma_mm\n", header);
  for (std::size_t j = 0; j < map.y.size(); ++j) {
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      csv += fmt::format("{:.8g},{:.8g},{:.6f}\n", map.x[i] / x_unit, map.y[j] / y_unit,
                         map.sigma[j * map.x.size() + i] / mm);
    }
  }
  return csv;
}

std::string monte_carlo_csv(const MonteCarloResult& m) {
  std::string csv = "run,lateral_error_mm,vertical_error_mm,longitudinal_error_mm\n";
  for (std::size_t i = 0; i < m.lateral.size(); ++i) {
    csv += fmt::format("{},{:.6f},{:.6f},{:.6f}\n", i, m.lateral[i] / mm, m.vertical[i] / mm, m.longitudinal[i] / mm);
  }
  return csv;
}

/// Figure 5 of Jiang: one interval by itself, by closed forms and by filter and smoother.
struct Interval {
  std::vector<fusion::ProfilePoint> closed, smoothed;
};

Interval one_interval(const PlanConfig& c) {
  fusion::PlanCase one = c.plan;
  one.intervals = 1;
  Interval out{{}, fusion::chain_accuracy(one, 0.0).profile};
  for (const auto& p : out.smoothed) out.closed.push_back({p.distance, fusion::closed_form_sigma(one, p.distance)});
  return out;
}

std::string interval_csv(const Interval& interval) {
  std::string csv =
      "distance_m,lateral_sigma_mm,vertical_sigma_mm,longitudinal_sigma_mm,closed_lateral_sigma_mm,"
      "closed_vertical_sigma_mm,closed_longitudinal_sigma_mm\n";
  for (std::size_t i = 0; i < interval.smoothed.size(); ++i) {
    const auto &s = interval.smoothed[i].sigma, &k = interval.closed[i].sigma;
    csv +=
        fmt::format("{:.3f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", interval.smoothed[i].distance, s.lateral / mm,
                    s.vertical / mm, s.longitudinal / mm, k.lateral / mm, k.vertical / mm, k.longitudinal / mm);
  }
  return csv;
}

report::PlanProfile profile_of(const std::vector<fusion::ProfilePoint>& profile, std::string name = {}) {
  report::PlanProfile out{.name = std::move(name)};
  for (const auto& p : profile) {
    out.distance.push_back(p.distance);
    out.sigma[0].push_back(p.sigma.lateral / mm);
    out.sigma[1].push_back(p.sigma.vertical / mm);
    out.sigma[2].push_back(p.sigma.longitudinal / mm);
  }
  return out;
}

report::PlanMap map_of(const fusion::SigmaMap& map, double x_unit, double y_unit) {
  report::PlanMap out;
  for (const double x : map.x) out.x.push_back(x / x_unit);
  for (const double y : map.y) out.y.push_back(y / y_unit);
  for (const double s : map.sigma) out.sigma.push_back(s / mm);
  return out;
}

std::array<double, 3> three(const fusion::Directions& d, double unit) {
  return {d.lateral / unit, d.vertical / unit, d.longitudinal / unit};
}

/// What the figures show.
report::PlanReport figures_of(const PlanConfig& c, const PlanResult& r) {
  report::PlanReport out;
  const Interval interval = one_interval(c);
  out.required_mm = c.required / mm;
  out.closed = profile_of(interval.closed);
  out.smoothed = profile_of(interval.smoothed);
  out.run = profile_of(r.chain.profile);
  out.lateral = map_of(r.lateral, deg_per_hour, deg_per_sqrt_hour);
  out.vertical = map_of(r.vertical, deg_per_hour, deg_per_sqrt_hour);
  out.longitudinal = map_of(r.longitudinal, ppm, ppm);
  for (const auto& m : r.methods) out.methods.push_back(profile_of(m.profile, to_string(m.method)));
  if (r.monte_carlo) {
    const std::vector<double>* errors[] = {&r.monte_carlo->lateral, &r.monte_carlo->vertical,
                                           &r.monte_carlo->longitudinal};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double e : *errors[k]) out.errors[k].push_back(e / mm);
    }
    out.rms = three(r.monte_carlo->rms, mm);
    out.predicted = three(r.monte_carlo->predicted, mm);
  }
  return out;
}

}  // namespace

Expected<void> write_plan_tables(const std::filesystem::path& folder, const PlanConfig& c, const PlanResult& r) {
  const double bias = deg_per_hour, walk = deg_per_sqrt_hour;
  std::vector<std::pair<std::string, std::string>> files{
      {"plan.txt", plan_text(c, r)},
      {"interval.csv", interval_csv(one_interval(c))},
      {"profile.csv", profile_csv(r.chain.profile)},
      {"map_lateral.csv", map_csv(r.lateral, "gyro_bias_deg_per_h,random_walk_deg_per_sqrt_h", bias, walk)},
      {"map_vertical.csv", map_csv(r.vertical, "gyro_bias_deg_per_h,random_walk_deg_per_sqrt_h", bias, walk)},
      {"map_longitudinal.csv", map_csv(r.longitudinal, "scale_ppm,scale_walk_ppm_per_sqrt_s", ppm, ppm)}};
  for (const auto& m : r.methods) {
    std::string name = to_string(m.method);
    std::replace(name.begin(), name.end(), '/', '_');
    files.emplace_back("method_" + name + ".csv", profile_csv(m.profile));
  }
  if (r.monte_carlo) {
    files.emplace_back("monte_carlo.csv", monte_carlo_csv(*r.monte_carlo));
    std::vector<fusion::ProfilePoint> rms;
    for (const auto& p : r.monte_carlo->profile) rms.push_back({p.distance, p.rms});
    files.emplace_back("monte_carlo_profile.csv", profile_csv(rms));
  }
  for (const auto& [name, text] : files) {
    if (auto done = write_text(folder / name, text); !done) return done;
  }
  return {};
}

Expected<void> write_plan_figures(const std::filesystem::path& folder, const PlanConfig& c, const PlanResult& r) {
  const report::PlanReport shown = figures_of(c, r);
  const report::Texts texts;
  const std::pair<const char*, std::vector<report::Figure>> files[] = {
      {"sigma.svg", report::plan_sigma_figures(shown, texts)},
      {"maps.svg", report::plan_map_figures(shown, texts)},
      {"methods.svg", report::plan_method_figures(shown, texts)},
      {"monte_carlo.svg", report::plan_histograms(shown, texts)}};
  for (const auto& [name, figures] : files) {
    if (figures.empty()) continue;
    if (auto done = write_text(folder / name, report::to_svg(figures, 2)); !done) return done;
  }
  return {};
}

}  // namespace versine::app
