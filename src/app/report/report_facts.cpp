// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <map>

#include "report_reading.hpp"
#include "versine/core/calendar.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

Error no_result(const std::filesystem::path& folder, std::string found) {
  return {.file = folder.string(),
          .found = std::move(found),
          .expected = "the result folder of a Versine job, with run.json",
          .advice = "name the folder that 'versine survey', 'geometry', 'georef' or 'plan' printed as its result"};
}

TimeScale scale_of(const json& run) {
  const std::string text = run.value("time_scale", "");
  return text.starts_with("GPS") ? TimeScale::gps : text.starts_with("UTC") ? TimeScale::utc : TimeScale::recorder;
}

/// The day on which a recording began; nothing for a recorder's own clock.
std::string day_of(const json& run) {
  const TimeScale scale = scale_of(run);
  const auto results = run.find("results");
  if (scale == TimeScale::recorder || results == run.end() || !results->contains("segments")) return "";
  const json& segments = (*results)["segments"];
  if (!segments.is_array() || segments.empty() || !segments[0].contains("from_s")) return "";
  const Time from = Time::from_seconds(segments[0]["from_s"].get<double>());
  return to_text(scale == TimeScale::gps ? utc_from_gps(from) : from, TimeScale::utc).substr(0, 16) + " UTC";
}

/// Keys that hold something, as "table.key".
void flatten(const json& value, const std::string& name, report::RawTable& out) {
  if (value.is_object()) {
    const auto file = value.find("file");  // a sensor that the job does not name
    if (file != value.end() && file->is_string() && file->get<std::string>().empty()) return;
    for (const auto& [key, inner] : value.items()) flatten(inner, name.empty() ? key : name + "." + key, out);
    return;
  }
  if (value.is_array() && !value.empty() && value[0].is_object()) {
    for (std::size_t i = 0; i < value.size(); ++i) flatten(value[i], fmt::format("{}[{}]", name, i + 1), out);
    return;
  }
  const std::string text = text_of(value);
  if (!text.empty()) out.rows.push_back({name, text});
}

/// One row for all rejections of a sensor for one reason.
report::RawTable grouped(const json& rejections) {
  struct Kind {
    std::size_t count = 0;
    double first = 0.0, last = 0.0, worst = 0.0;
  };
  std::map<std::pair<std::string, std::string>, Kind> kinds;
  for (const json& r : rejections) {
    Kind& k = kinds[{r.value("sensor", ""), r.value("reason", "")}];
    const double t = r.contains("time_s") && r["time_s"].is_number() ? r["time_s"].get<double>() : 0.0;
    if (k.count++ == 0) k.first = k.last = t;
    k.first = std::min(k.first, t);
    k.last = std::max(k.last, t);
    if (r.contains("normalized") && r["normalized"].is_number())
      k.worst = std::max(k.worst, r["normalized"].get<double>());
  }
  report::RawTable out{{"sensor", "reason", "count", "first_s", "last_s", "worst"}, {}};
  for (const auto& [name, k] : kinds) {
    out.rows.push_back({name.first, name.second, fmt::format("{}", k.count), fmt::format("{:.3f}", k.first),
                        fmt::format("{:.3f}", k.last), k.worst > 0.0 ? fmt::format("{:.2f}", k.worst) : ""});
  }
  return out;
}

report::RawTable list_of(const json& list, std::vector<std::string> keys) {
  report::RawTable out{std::move(keys), {}};
  for (const json& item : list) {
    auto& row = out.rows.emplace_back();
    for (const std::string& key : out.header) row.push_back(item.contains(key) ? text_of(item[key]) : "");
  }
  return out;
}

}  // namespace

std::string text_of(const json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_float()) return fmt::format("{:.10g}", value.get<double>());
  if (value.is_array()) {
    std::string text;
    for (const json& item : value) text += (text.empty() ? "" : ", ") + text_of(item);
    return text;
  }
  return value.dump();
}

Expected<json> read_run(const std::filesystem::path& folder) {
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) return tl::unexpected(no_result(folder, "no folder"));
  if (std::filesystem::is_empty(folder, code)) return tl::unexpected(no_result(folder, "an empty folder"));
  std::ifstream file(folder / "run.json", std::ios::binary);
  if (!file) return tl::unexpected(no_result(folder, "a folder without run.json"));
  json run = json::parse(file, nullptr, false);
  if (run.is_discarded() || !run.is_object()) {
    return fail({.file = (folder / "run.json").string(),
                 .found = "a file that was cut short or is no JSON",
                 .expected = "run.json as Versine writes it",
                 .advice = "run the job again; a result is copied whole or not at all"});
  }
  if (run.value("format", "") != "versine run 1") {
    return fail({.file = (folder / "run.json").string(),
                 .field = "format",
                 .found = "'" + run.value("format", "") + "'",
                 .expected = "'versine run 1'",
                 .advice = "another version of Versine made this result: make the report with that one, or run the job "
                           "again with this one"});
  }
  return run;
}

report::Facts read_facts(const std::filesystem::path& folder, const json& run) {
  report::Facts f;
  const json settings = run.value("settings", json::object());
  f.title = settings.value("title", "");
  for (const json& input : run.value("inputs", json::array())) {
    if (!f.title.empty() || input.value("role", "") != "job") continue;
    f.title = std::filesystem::path(input.value("file", "")).stem().string();
  }
  if (f.title.empty()) f.title = folder.filename().string();
  if (const auto r = settings.find("report"); r != settings.end() && r->is_object()) {
    report::Cover& c = f.cover;
    const std::pair<const char*, std::string*> keys[] = {
        {"line", &c.line},      {"track", &c.track},     {"direction", &c.direction},
        {"date", &c.date},      {"shift", &c.shift},     {"operator", &c.operated_by},
        {"client", &c.client},  {"trolley", &c.trolley}, {"calibrated", &c.calibrated},
        {"remarks", &c.remarks}};
    for (const auto& [key, target] : keys) *target = r->value(key, "");
  }
  if (f.cover.date.empty()) f.cover.date = day_of(run);
  f.folder = folder.filename().string();
  f.command = run.value("command", "");
  f.version = run.value("version", "");
  f.started = run.value("started_utc", "");
  f.inputs = list_of(run.value("inputs", json::array()), {"role", "file", "bytes", "sha256"});
  f.settings.header = {"key", "value"};
  flatten(settings, "", f.settings);
  f.timings.header = {"stage", "seconds"};
  const json timings = run.value("timings_s", json::object());
  for (const auto& [stage, seconds] : timings.items()) {
    f.timings.rows.push_back({stage, fmt::format("{:.3f}", seconds.get<double>())});
  }
  for (const json& w : run.value("warnings", json::array())) f.warnings.push_back(text_of(w));
  f.findings =
      list_of(run.value("findings", json::array()), {"sensor", "kind", "from", "to_s", "count", "action", "detail"});
  f.rejections = grouped(run.value("rejections", json::array()));
  return f;
}

Expected<report::RawTable> read_raw(const std::filesystem::path& path, char delimiter) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) return report::RawTable{};
  auto table = TextTable::read(path, delimiter);
  if (!table) return tl::unexpected(table.error());
  return report::RawTable{std::move(table->header), std::move(table->rows)};
}

}  // namespace versine::app
