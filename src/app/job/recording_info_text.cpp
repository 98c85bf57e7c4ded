// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "versine/app/recording_info.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {
const char* name_of(TimeScale scale) {
  return scale == TimeScale::gps   ? "GPS time"
         : scale == TimeScale::utc ? "UTC"
                                   : "recorder's own clock, or seconds of a week";
}

double rate_of(const TimeInfo& time) {
  return time.interval.ns > 0 ? 1.0 / time.interval.seconds() : 0.0;
}
}  // namespace

std::string to_text(const RecordingInfo& info) {
  std::string text = fmt::format("{}\n  {}\n  {} samples\n", info.path.string(), info.format, info.samples);
  if (info.time) {
    const TimeInfo& t = *info.time;
    text += fmt::format(
        "  from {} to {} ({}), {:.3f} s\n  one sample every {:.6g} s ({:.6g} Hz), {} gaps, longest {:.3f} s\n",
        to_text(t.from, t.scale), to_text(t.to, t.scale), name_of(t.scale), (t.to - t.from).seconds(),
        t.interval.seconds(), rate_of(t), t.gaps, t.longest_gap.seconds());
    if (t.out_of_order > 0) text += fmt::format("  {} times that do not increase\n", t.out_of_order);
  }
  if (info.box) {
    const auto& [low, high] = *info.box;
    text += fmt::format("  latitude {:.7f} to {:.7f} deg, longitude {:.7f} to {:.7f} deg, height {:.1f} to {:.1f} m\n",
                        low.latitude / units::deg, high.latitude / units::deg, low.longitude / units::deg,
                        high.longitude / units::deg, low.height, high.height);
  }
  for (const auto& [fix, count] : info.fixes) text += fmt::format("  {} fixes: {}\n", fix, count);
  if (!info.columns.empty()) {
    text += fmt::format("\n  {:24} {:26} {:>13} {:>13} {:>13}\n", "column", "read as", "least", "mean", "greatest");
  }
  for (const ColumnInfo& c : info.columns) {
    const std::string as = c.versines.empty() ? "(not by itself)" : c.versines;
    if (c.numbers == 0) {
      text += fmt::format("  {:24} {:26} text, such as '{}'\n", c.name, as, c.example);
      continue;
    }
    text += fmt::format("  {:24} {:26} {:13.7g} {:13.7g} {:13.7g}", c.name, as, c.min, c.mean, c.max);
    text += c.missing > 0 ? fmt::format("  {} missing\n", c.missing) : "\n";
  }
  if (!info.guesses.empty()) text += "\n  Guesses:\n";
  for (const Guess& g : info.guesses) text += fmt::format("  - {}\n    ({})\n", g.what, g.reason);
  if (!info.findings.empty()) text += "\n  Findings:\n";
  for (const std::string& f : info.findings) text += "  - " + f + "\n";
  return text;
}

std::string to_json(const RecordingInfo& info) {
  using Json = nlohmann::ordered_json;
  Json root{{"file", info.path.string()}, {"format", info.format}, {"samples", info.samples}};
  if (info.time) {
    const TimeInfo& t = *info.time;
    root["time"] = {{"scale", name_of(t.scale)},
                    {"from_s", seconds_text(t.from)},
                    {"to_s", seconds_text(t.to)},
                    {"duration_s", (t.to - t.from).seconds()},
                    {"interval_s", t.interval.seconds()},
                    {"gaps", t.gaps},
                    {"longest_gap_s", t.longest_gap.seconds()},
                    {"out_of_order", t.out_of_order}};
  }
  if (info.box) {
    const auto& [low, high] = *info.box;
    root["box"] = {{"latitude_deg", {low.latitude / units::deg, high.latitude / units::deg}},
                   {"longitude_deg", {low.longitude / units::deg, high.longitude / units::deg}},
                   {"height_m", {low.height, high.height}}};
  }
  for (const auto& [fix, count] : info.fixes) root["fixes"][fix] = count;
  root["columns"] = Json::array();
  for (const ColumnInfo& c : info.columns) {
    root["columns"].push_back({{"name", c.name},
                               {"read_as", c.versines},
                               {"numbers", c.numbers},
                               {"missing", c.missing},
                               {"min", c.min},
                               {"mean", c.mean},
                               {"max", c.max},
                               {"example", c.example}});
  }
  root["guesses"] = Json::array();
  for (const Guess& g : info.guesses) root["guesses"].push_back({{"guess", g.what}, {"reason", g.reason}});
  root["findings"] = info.findings;
  return root.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace versine::app
