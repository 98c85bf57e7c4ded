// SPDX-License-Identifier: Apache-2.0
#include "view_packup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/track/geometry.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

class List {
 public:
  void add(const char* name, bool good, std::string text) {
    items.push_back({{"name", name}, {"good", good}, {"text", std::move(text)}});
  }
  json items = json::array();
};

/// Metres of the grid whose flags have a bit.
void add_length(List& list, const char* name, const SurveyGrid& grid, std::uint32_t bit, double step) {
  const auto n = std::count_if(grid.flags.begin(), grid.flags.end(),
                               [&](double f) { return (static_cast<std::uint32_t>(f) & bit) != 0; });
  list.add(name, n == 0, n == 0 ? "none" : fmt::format("{:.2f} m", static_cast<double>(n) * step));
}

/// Holes that split the recording: nothing is known of the time between.
void add_recording(List& list, const json& findings) {
  std::size_t gaps = 0;
  std::string first;
  for (const json& f : findings) {
    if (f.value("action", "") != "split") continue;
    if (gaps++ == 0) first = f.value("detail", "") + ", from " + f.value("from", "");
  }
  list.add("gaps in the recording", gaps == 0, gaps == 0 ? "none" : fmt::format("{}, the first {}", gaps, first));
}

/// Where the heading is found from the Earth's rotation, the start must stand as long as the job counts on.
void add_standstill(List& list, const json& results, const json& settings) {
  const json s = results.value("standstills", json());
  if (!s.is_object()) return;
  const double first = s.value("first_s", 0.0);
  const double wanted = settings.value("alignment", json::object()).value("duration_s", 0.0);
  bool gyrocompass = false;
  for (const json& segment : results.value("segments", json::array())) {
    gyrocompass = gyrocompass || segment.value("alignment", "") == "gyrocompass";
  }
  const bool good = !gyrocompass || first >= 0.5 * wanted;
  std::string text = fmt::format("{} times, {:.0f} s at the start", s.value("count", 0), first);
  if (!good) text += fmt::format(" of {:.0f} s wanted for the heading", wanted);
  list.add("standstills", good, text);
}

void add_control(List& list, const SurveyGrid& grid, const std::vector<double>& distance, const json& control) {
  if (control.empty() || distance.empty()) return;
  const auto travelled = [&](const json& c) {
    const auto it = std::lower_bound(grid.x->begin(), grid.x->end(), c["x"].get<double>());
    return distance[std::min(static_cast<std::size_t>(it - grid.x->begin()), distance.size() - 1)];
  };
  std::size_t rejected = 0;
  double apart = 0.0, last = distance.front();
  for (const json& c : control) {
    if (!c["used"].get<bool>()) {
      ++rejected;
      continue;
    }
    apart = std::max(apart, std::abs(travelled(c) - last));
    last = travelled(c);
  }
  apart = std::max(apart, std::abs(distance.back() - last));
  list.add("control points", rejected == 0,
           fmt::format("{} used, {} rejected, at most {:.0f} m without", control.size() - rejected, rejected, apart));
}

/// Whether sensors agree with the run: at the end by their statistics, before by what was rejected.
void add_sensors(List& list, const json& results) {
  for (const json& i : results.value("innovations", json::array())) {
    const std::string sensor = i.value("sensor", "");
    if (sensor != "landmark" && sensor != "gnss position") continue;
    const double nis = i.value("mean_nis_per_row", 0.0), upper = i.value("upper", 0.0);
    list.add(sensor == "landmark" ? "closure on control points" : "agreement with GNSS", nis <= upper,
             nis <= upper ? "within its sigmas" : fmt::format("{:.1f} times its sigmas", std::sqrt(nis)));
  }
  for (const json& i : results.value("sensors", json::array())) {
    if (i.value("sensor", "") != "gnss position") continue;
    const int used = i.value("used", 0), rejected = i.value("rejected", 0);
    list.add("GNSS", 20 * rejected <= used + rejected, fmt::format("{} used, {} rejected", used, rejected));
  }
}

}  // namespace

json pack_up_of(const SurveyFiles& files, const SurveyGrid& grid, const std::vector<double>& distance,
                const json& control, const json& exceedances) {
  List list;
  const json results = files.run.value("results", json::object());
  add_recording(list, files.run.value("findings", json::array()));
  if (!grid.flags.empty()) {
    const double step = files.results.value("step_m", 0.25);
    add_length(list, "gaps in the trajectory", grid, track::no_trajectory, step);
    add_length(list, "without gauge", grid, track::no_gauge, step);
    if (!files.settings.value("design", "").empty()) add_length(list, "off the design", grid, track::off_design, step);
  }
  add_standstill(list, results, files.run.value("settings", json::object()));
  add_control(list, grid, distance, control);
  add_sensors(list, results);
  if (!exceedances.empty()) {
    const auto doubtful = std::count_if(exceedances.begin(), exceedances.end(), [](const json& e) {
      return e["probability"].is_number() && e["probability"] < 0.95;
    });
    list.add("doubtful exceedances", doubtful == 0,
             doubtful == 0 ? "none: each is certain to 95 %" : fmt::format("{} to re-measure (below 95 %)", doubtful));
  }
  return std::move(list.items);
}

}  // namespace versine::app
