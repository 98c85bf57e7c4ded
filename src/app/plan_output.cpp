// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "versine/app/plan.hpp"
#include "versine/core/units.hpp"
#include "versine/report/figure.hpp"

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

enum class Direction { lateral, vertical, longitudinal };
double along(const fusion::Directions& d, Direction direction) {
  return direction == Direction::lateral ? d.lateral : direction == Direction::vertical ? d.vertical : d.longitudinal;
}

report::Curve curve(std::string name, const std::vector<fusion::ProfilePoint>& profile, Direction direction) {
  report::Curve c{.name = std::move(name)};
  for (const auto& p : profile) {
    c.x.push_back(p.distance);
    c.y.push_back(along(p.sigma, direction) / mm);
  }
  return c;
}

/// Figure 5 of Jiang: one interval, closed forms as lines, filter and smoother as points.
report::Figure interval_figure(const PlanConfig& c) {
  fusion::PlanCase one = c.plan;
  one.intervals = 1;
  const auto chain = fusion::chain_accuracy(one, 0.0);
  report::Figure f{
      .title = "One interval by itself", .x = {.label = "distance, m"}, .y = {.label = "sigma, mm", .low = 0.0}};
  const std::pair<const char*, Direction> rows[] = {
      {"lateral", Direction::lateral}, {"vertical", Direction::vertical}, {"longitudinal", Direction::longitudinal}};
  int colour = 0;
  for (const auto& [name, direction] : rows) {
    report::Curve closed{.name = fmt::format("{}, closed form", name), .colour = colour};
    report::Curve smoothed{
        .name = fmt::format("{}, filter and smoother", name), .style = report::CurveStyle::points, .colour = colour++};
    for (std::size_t k = 0; k < chain.profile.size(); ++k) {
      const auto& p = chain.profile[k];
      closed.x.push_back(p.distance);
      closed.y.push_back(along(fusion::closed_form_sigma(one, p.distance), direction) / mm);
      if (k % 4 != 0) continue;
      smoothed.x.push_back(p.distance);
      smoothed.y.push_back(along(p.sigma, direction) / mm);
    }
    f.curves.push_back(std::move(closed));
    f.curves.push_back(std::move(smoothed));
  }
  return f;
}

report::Figure run_figure(const PlanConfig& c, const PlanResult& r) {
  report::Figure f{.title = "Chained run", .x = {.label = "distance, m"}, .y = {.label = "sigma, mm", .low = 0.0}};
  f.curves = {curve("lateral", r.chain.profile, Direction::lateral),
              curve("vertical", r.chain.profile, Direction::vertical),
              curve("longitudinal", r.chain.profile, Direction::longitudinal)};
  f.curves.push_back({.name = "required",
                      .x = {0.0, r.chain.profile.back().distance},
                      .y = {c.required / mm, c.required / mm},
                      .style = report::CurveStyle::dashed,
                      .colour = 6});
  return f;
}

/// Figure 6 of Jiang.
report::Figure map_figure(const fusion::SigmaMap& map, const char* title, const char* x_label, const char* y_label,
                          double x_unit, double y_unit, double required) {
  report::Figure f{.title = title, .x = {.label = x_label}, .y = {.label = y_label}};
  report::Field field{.emphasis = required / mm, .label = fmt::format("{:.2f} mm required", required / mm)};
  for (const double x : map.x) field.x.push_back(x / x_unit);
  for (const double y : map.y) field.y.push_back(y / y_unit);
  for (const double s : map.sigma) field.value.push_back(s / mm);
  const auto [low, high] = std::minmax_element(field.value.begin(), field.value.end());
  field.contours = report::ticks(*low, *high, 7);
  f.field = std::move(field);
  return f;
}

/// Figure 7 of Jiang: errors of the runs against the normal distribution predicted.
report::Figure histogram(const std::vector<double>& errors, double rms, double predicted, const char* title) {
  const double width = 0.25 * std::max(rms, 1e-9), limit = 4.0 * std::max(rms, predicted);
  const int half = std::max(1, static_cast<int>(limit / width));
  std::vector<double> counts(static_cast<std::size_t>(2 * half + 1), 0.0);
  for (const double e : errors) {
    const auto bin = std::lround(e / width) + half;
    if (bin >= 0 && bin < static_cast<long>(counts.size())) ++counts[static_cast<std::size_t>(bin)];
  }
  report::Figure f{.title = fmt::format("{}: RMS {:.2f} mm, predicted {:.2f} mm", title, rms / mm, predicted / mm),
                   .x = {.label = "error, mm"},
                   .y = {.label = "runs"}};
  report::Curve bars{.name = "runs", .style = report::CurveStyle::bars}, normal{.name = "predicted"};
  const double n = static_cast<double>(errors.size());
  for (int k = -half; k <= half; ++k) {
    bars.x.push_back(k * width / mm);
    bars.y.push_back(counts[static_cast<std::size_t>(k + half)]);
  }
  for (double e = -limit; e <= limit; e += 0.1 * width) {
    normal.x.push_back(e / mm);
    normal.y.push_back(n * width / predicted * std::exp(-0.5 * e * e / (predicted * predicted)) /
                       std::sqrt(2 * std::acos(-1.0)));
  }
  f.curves = {std::move(bars), std::move(normal)};
  return f;
}

/// Figure 8 of Jiang.
report::Figure method_figure(const PlanResult& r, Direction direction, const char* title) {
  report::Figure f{.title = title, .x = {.label = "distance, m"}, .y = {.label = "sigma, mm", .logarithmic = true}};
  for (const auto& m : r.methods) f.curves.push_back(curve(to_string(m.method), m.profile, direction));
  return f;
}

}  // namespace

Expected<void> write_plan_tables(const std::filesystem::path& folder, const PlanConfig& c, const PlanResult& r) {
  const double bias = deg_per_hour, walk = deg_per_sqrt_hour;
  std::vector<std::pair<std::string, std::string>> files{
      {"plan.txt", plan_text(c, r)},
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
  std::vector<std::pair<std::string, std::string>> files;
  const report::Figure sigma[] = {interval_figure(c), run_figure(c, r)};
  files.emplace_back("sigma.svg", report::to_svg(sigma, 2));
  const report::Figure maps[] = {
      map_figure(r.lateral, "Lateral sigma at mid-interval, mm", "gyro bias, deg/h", "random walk, deg/sqrt(h)",
                 deg_per_hour, deg_per_sqrt_hour, c.required),
      map_figure(r.vertical, "Vertical sigma at mid-interval, mm", "gyro bias, deg/h", "random walk, deg/sqrt(h)",
                 deg_per_hour, deg_per_sqrt_hour, c.required),
      map_figure(r.longitudinal, "Longitudinal sigma at mid-interval, mm", "odometer scale, ppm",
                 "its random walk, ppm/sqrt(s)", ppm, ppm, c.required)};
  files.emplace_back("maps.svg", report::to_svg(maps, 2));
  if (!r.methods.empty()) {
    const report::Figure methods[] = {method_figure(r, Direction::lateral, "Lateral"),
                                      method_figure(r, Direction::vertical, "Vertical"),
                                      method_figure(r, Direction::longitudinal, "Longitudinal")};
    files.emplace_back("methods.svg", report::to_svg(methods, 2));
  }
  if (r.monte_carlo) {
    const auto& m = *r.monte_carlo;
    const report::Figure histograms[] = {
        histogram(m.lateral, m.rms.lateral, m.predicted.lateral, "Lateral"),
        histogram(m.vertical, m.rms.vertical, m.predicted.vertical, "Vertical"),
        histogram(m.longitudinal, m.rms.longitudinal, m.predicted.longitudinal, "Longitudinal")};
    files.emplace_back("monte_carlo.svg", report::to_svg(histograms, 2));
  }
  for (const auto& [name, text] : files) {
    if (auto done = write_text(folder / name, text); !done) return done;
  }
  return {};
}

}  // namespace versine::app
