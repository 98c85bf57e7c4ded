// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/report/plan_report.hpp"

namespace versine::report {

namespace {

constexpr std::array direction_keys{"plan.lateral", "plan.vertical", "plan.longitudinal"};

Curve curve(std::string name, const PlanProfile& p, std::size_t direction, int colour = -1) {
  return {.name = std::move(name), .x = p.distance, .y = p.sigma[direction], .colour = colour};
}

/// Figure 5: closed forms as lines, filter and smoother as points.
Figure interval_figure(const PlanReport& r, const Texts& t) {
  Figure f{
      .title = t("plan.interval"), .x = {.label = t("plan.distance")}, .y = {.label = t("plan.sigma_mm"), .low = 0.0}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string name = t(direction_keys[k]);
    const int colour = static_cast<int>(k);
    f.curves.push_back(curve(fmt::format(fmt::runtime(t("plan.closed")), name), r.closed, k, colour));
    Curve points{
        .name = fmt::format(fmt::runtime(t("plan.smoothed")), name), .style = CurveStyle::points, .colour = colour};
    for (std::size_t i = 0; i < r.smoothed.distance.size(); i += 4) {
      points.x.push_back(r.smoothed.distance[i]);
      points.y.push_back(r.smoothed.sigma[k][i]);
    }
    f.curves.push_back(std::move(points));
  }
  return f;
}

Figure run_figure(const PlanReport& r, const Texts& t) {
  Figure f{.title = t("plan.run"), .x = {.label = t("plan.distance")}, .y = {.label = t("plan.sigma_mm"), .low = 0.0}};
  for (std::size_t k = 0; k < 3; ++k) f.curves.push_back(curve(t(direction_keys[k]), r.run, k));
  if (!r.run.distance.empty()) {
    f.curves.push_back({.name = t("plan.required_line"),
                        .x = {0.0, r.run.distance.back()},
                        .y = {r.required_mm, r.required_mm},
                        .style = CurveStyle::dashed,
                        .colour = 6});
  }
  return f;
}

Figure map_figure(const PlanMap& map, const std::string& title, const std::string& x, const std::string& y,
                  double required, const Texts& t) {
  Figure f{.title = title, .x = {.label = x}, .y = {.label = y}};
  if (map.sigma.empty()) return f;
  const auto [low, high] = std::minmax_element(map.sigma.begin(), map.sigma.end());
  f.field = Field{.x = map.x,
                  .y = map.y,
                  .value = map.sigma,
                  .contours = ticks(*low, *high, 7),
                  .emphasis = required,
                  .label = fmt::format(fmt::runtime(t("plan.required_mm")), required)};
  return f;
}

/// Figure 7: errors of the runs against the normal distribution predicted.
Figure histogram(const std::vector<double>& errors, double rms, double predicted, const std::string& name,
                 const Texts& t) {
  const double width = 0.25 * std::max(rms, 1e-6), limit = 4.0 * std::max(rms, predicted);
  const int half = std::max(1, static_cast<int>(limit / width));
  std::vector<double> counts(static_cast<std::size_t>(2 * half + 1), 0.0);
  for (const double e : errors) {
    const auto bin = std::lround(e / width) + half;
    if (bin >= 0 && bin < static_cast<long>(counts.size())) ++counts[static_cast<std::size_t>(bin)];
  }
  Figure f{.title = fmt::format(fmt::runtime(t("plan.histogram")), name, rms, predicted),
           .x = {.label = t("plan.error_mm")},
           .y = {.label = t("plan.runs")}};
  Curve bars{.name = t("plan.runs"), .style = CurveStyle::bars}, normal{.name = t("plan.predicted")};
  const double n = static_cast<double>(errors.size());
  for (int k = -half; k <= half; ++k) {
    bars.x.push_back(k * width);
    bars.y.push_back(counts[static_cast<std::size_t>(k + half)]);
  }
  for (double e = -limit; e <= limit; e += 0.1 * width) {
    normal.x.push_back(e);
    normal.y.push_back(n * width / predicted * std::exp(-0.5 * e * e / (predicted * predicted)) /
                       std::sqrt(2.0 * std::numbers::pi));
  }
  f.curves = {std::move(bars), std::move(normal)};
  return f;
}

}  // namespace

std::vector<Figure> plan_sigma_figures(const PlanReport& r, const Texts& t) {
  return {interval_figure(r, t), run_figure(r, t)};
}

std::vector<Figure> plan_map_figures(const PlanReport& r, const Texts& t) {
  return {map_figure(r.lateral, t("plan.map_lateral"), t("plan.bias_axis"), t("plan.walk_axis"), r.required_mm, t),
          map_figure(r.vertical, t("plan.map_vertical"), t("plan.bias_axis"), t("plan.walk_axis"), r.required_mm, t),
          map_figure(r.longitudinal, t("plan.map_longitudinal"), t("plan.scale_axis"), t("plan.scale_walk_axis"),
                     r.required_mm, t)};
}

std::vector<Figure> plan_method_figures(const PlanReport& r, const Texts& t) {
  std::vector<Figure> out;
  for (std::size_t k = 0; k < 3 && !r.methods.empty(); ++k) {
    Figure f{.title = fmt::format(fmt::runtime(t("plan.method_figure")), t(direction_keys[k])),
             .x = {.label = t("plan.distance")},
             .y = {.label = t("plan.sigma_mm"), .logarithmic = true}};
    for (const PlanProfile& m : r.methods) f.curves.push_back(curve(m.name, m, k));
    out.push_back(std::move(f));
  }
  return out;
}

std::vector<Figure> plan_histograms(const PlanReport& r, const Texts& t) {
  std::vector<Figure> out;
  for (std::size_t k = 0; k < 3 && !r.errors[k].empty(); ++k) {
    out.push_back(histogram(r.errors[k], r.rms[k], r.predicted[k], t(direction_keys[k]), t));
  }
  return out;
}

}  // namespace versine::report
