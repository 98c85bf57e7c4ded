// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "versine/app/plan.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {

using namespace units;

std::string row(const char* name, const fusion::Directions& d) {
  return fmt::format("  {:<44}{:>9.2f}{:>10.2f}{:>14.2f}\n", name, d.lateral / mm, d.vertical / mm,
                     d.longitudinal / mm);
}

nlohmann::json json_of(const fusion::Directions& d) {
  return {{"lateral_mm", d.lateral / mm}, {"vertical_mm", d.vertical / mm}, {"longitudinal_mm", d.longitudinal / mm}};
}

nlohmann::json scaled(const std::optional<double>& x, double unit) {
  return x ? nlohmann::json(*x / unit) : nlohmann::json(nullptr);
}

std::string answers(const PlanConfig& c, const PlanResult& r) {
  std::string text = "What would do (for the requirement, all else as planned)\n";
  text += r.spacing ? fmt::format("  landmarks may be {:.1f} m apart\n", *r.spacing)
                    : "  no spacing of 1 m or more does: better landmarks are needed\n";
  text += r.random_walk ? fmt::format("  gyro random walk may be {:.4f} deg/sqrt(h) at a bias of {:.3f} deg/h\n",
                                      *r.random_walk / deg_per_sqrt_hour, c.plan.gyro.bias / deg_per_hour)
                        : "  no random walk does at this bias and spacing\n";
  text += r.bias ? fmt::format("  gyro bias may be {:.3f} deg/h at a random walk of {:.4f} deg/sqrt(h)\n",
                               *r.bias / deg_per_hour, c.plan.gyro.random_walk / deg_per_sqrt_hour)
                 : "  no bias does at this random walk and spacing\n";
  text += fmt::format("  {:<18}{:>12}{:>22}\n", "grade", "sigma, mm", "largest spacing, m");
  for (const auto& g : r.grades) {
    text +=
        fmt::format("  {:<18}{:>12.2f}{:>22}{}\n", g.name, g.sigma / mm,
                    g.spacing ? fmt::format("{:.1f}", *g.spacing) : "none", g.sigma <= c.required ? "  enough" : "");
  }
  return text;
}

std::string simulated(const MonteCarloResult& m, std::size_t runs) {
  std::string text =
      fmt::format("Simulated: {} runs through the program, {:.0f} m from the start, mm\n", runs, m.middle);
  text += row("RMS of the runs", m.rms) + row("predicted", m.predicted);
  text += fmt::format("  inside 1.96 sigma, % (all places)           {:>9.1f}{:>10.1f}{:>14.1f}\n",
                      100 * m.coverage.lateral, 100 * m.coverage.vertical, 100 * m.coverage.longitudinal);
  text += fmt::format("  mean normalised squared error               {:>9.2f}  (3 when sigmas are honest)\n", m.nees);
  return text;
}

}  // namespace

std::string plan_text(const PlanConfig& c, const PlanResult& r) {
  const auto& p = c.plan;
  std::string text = fmt::format(
      "{}{}: bias {:.3f} deg/h, random walk {:.4f} deg/sqrt(h); landmark {:.2f} mm every {:.1f} m, {} intervals at "
      "{:.1f} km/h\n\n",
      c.title.empty() ? "" : c.title + "\n", c.grade, p.gyro.bias / deg_per_hour,
      p.gyro.random_walk / deg_per_sqrt_hour, p.landmark / mm, p.spacing, p.intervals, p.speed / kmh);
  text += fmt::format("Predicted standard deviation, mm{:>21}{:>10}{:>14}\n", "lateral", "vertical", "longitudinal");
  text += row("one interval by itself, worst place", r.interval_worst);
  text += row("one interval by itself, middle", fusion::closed_form_sigma(p, 0.5 * p.spacing));
  text += row("chained run, inner interval, worst place", r.chain.worst_interior);
  text += row("chained run, worst place", r.chain.worst);
  if (c.chord > 0.0) {
    const auto cross = [](const char* name, const fusion::Directions& d) {
      return fmt::format("  {:<44}{:>9.3f}{:>10.3f}\n", name, d.lateral / mm, d.vertical / mm);
    };
    text += cross(fmt::format("versine of {:.0f} m chord, worst place", c.chord).c_str(), r.chain.versine);
    if (r.chain.short_wave.lateral > 0.0) text += cross("30 m / 5 m check (d30), worst place", r.chain.short_wave);
  }
  text += fmt::format("\nRequired {:.2f} mm, {} {:.2f} mm: {}\n\n", c.required / mm,
                      c.basis == fusion::PlanBasis::interval ? "one interval by itself has" : "the chained run has",
                      r.sigma / mm, r.met ? "met" : "NOT met");
  const auto& d = r.derived;
  text += fmt::format(
      "Gyrocompassing at {:.1f} deg leaves {:.3f} deg of heading; equivalent bias {:.3f} (lateral gyro) and {:.3f} "
      "deg/h\n"
      "(vertical gyro), as a sum of magnitudes {:.3f} and {:.3f}; {:.3f} deg/h of it come back only with a turn.\n\n",
      p.latitude / deg, d.heading_error / deg, d.bias.lateral / deg_per_hour, d.bias.vertical / deg_per_hour,
      d.bias.lateral_worst / deg_per_hour, d.bias.vertical_worst / deg_per_hour,
      d.bias.returns_with_turn / deg_per_hour);
  text += answers(c, r);
  if (!r.methods.empty()) {
    text += fmt::format("\nMethods, inner interval, worst place, mm{:>13}{:>10}{:>14}\n", "lateral", "vertical",
                        "longitudinal");
    for (const auto& m : r.methods) text += row(to_string(m.method), m.worst_interior);
  }
  if (r.monte_carlo) text += "\n" + simulated(*r.monte_carlo, r.monte_carlo->lateral.size());
  return text;
}

std::string plan_json(const PlanConfig& c, const PlanResult& r) {
  nlohmann::json j = {{"required_mm", c.required / mm},
                      {"sigma_mm", r.sigma / mm},
                      {"met", r.met},
                      {"interval_worst", json_of(r.interval_worst)},
                      {"interval_middle", json_of(fusion::closed_form_sigma(c.plan, 0.5 * c.plan.spacing))},
                      {"chain_interior_worst", json_of(r.chain.worst_interior)},
                      {"chain_worst", json_of(r.chain.worst)},
                      {"heading_error_deg", r.derived.heading_error / deg},
                      {"equivalent_bias_deg_per_h",
                       {{"lateral_gyro", r.derived.bias.lateral / deg_per_hour},
                        {"vertical_gyro", r.derived.bias.vertical / deg_per_hour},
                        {"lateral_gyro_sum", r.derived.bias.lateral_worst / deg_per_hour},
                        {"vertical_gyro_sum", r.derived.bias.vertical_worst / deg_per_hour},
                        {"returns_with_turn", r.derived.bias.returns_with_turn / deg_per_hour}}},
                      {"largest_spacing_m", scaled(r.spacing, 1.0)},
                      {"largest_random_walk_deg_per_sqrt_h", scaled(r.random_walk, deg_per_sqrt_hour)},
                      {"largest_bias_deg_per_h", scaled(r.bias, deg_per_hour)},
                      {"planning_s", r.planning_s}};
  if (c.chord > 0.0) {
    j["versine"] = {{"chord_m", c.chord},
                    {"lateral_mm", r.chain.versine.lateral / mm},
                    {"vertical_mm", r.chain.versine.vertical / mm}};
    j["d30"] = {{"lateral_mm", r.chain.short_wave.lateral / mm}, {"vertical_mm", r.chain.short_wave.vertical / mm}};
  }
  for (const auto& g : r.grades) {
    j["grades"].push_back(
        {{"name", g.name}, {"sigma_mm", g.sigma / mm}, {"largest_spacing_m", scaled(g.spacing, 1.0)}});
  }
  for (const auto& m : r.methods) {
    j["methods"].push_back({{"name", to_string(m.method)}, {"interior_worst", json_of(m.worst_interior)}});
  }
  if (r.monte_carlo) {
    const auto& m = *r.monte_carlo;
    j["monte_carlo"] = {{"runs", m.lateral.size()},
                        {"middle_m", m.middle},
                        {"rms", json_of(m.rms)},
                        {"predicted", json_of(m.predicted)},
                        {"coverage",
                         {{"lateral", m.coverage.lateral},
                          {"vertical", m.coverage.vertical},
                          {"longitudinal", m.coverage.longitudinal}}},
                        {"nees", m.nees},
                        {"seconds", r.monte_carlo_s}};
  }
  return j.dump(2);
}

}  // namespace versine::app
