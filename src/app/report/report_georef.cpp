// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "report_reading.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

Expected<json> read_json(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  json out = json::parse(file, nullptr, false);
  if (file && !out.is_discarded()) return out;
  return fail({.file = path.string(),
               .found = file ? "a file that was cut short or is no JSON" : "that it is not there",
               .expected = "the files of one whole result of this version",
               .advice = "run the job again, or copy the result folder whole"});
}

/// A picture's metres around the first point: true to scale in both directions over a hundred kilometres.
class PictureMap {
 public:
  report::Point operator()(const json& point) {
    const double longitude = point[0].get<double>() * units::deg, latitude = point[1].get<double>() * units::deg;
    if (!std::isfinite(latitude_)) {
      latitude_ = latitude;
      longitude_ = longitude;
    }
    constexpr double radius = 6'371'000.0;
    return {radius * std::cos(latitude_) * (longitude - longitude_), radius * (latitude - latitude_)};
  }
  std::vector<report::Point> line(const json& points) {
    std::vector<report::Point> out;
    for (const json& p : points) out.push_back((*this)(p));
    return out;
  }

 private:
  double latitude_ = NAN, longitude_ = NAN;
};

std::string number(const json& object, const char* key, const char* format) {
  return object.contains(key) && object[key].is_number() ? fmt::format(fmt::runtime(format), object[key].get<double>())
                                                         : "";
}

std::string joined(const json& list) {
  std::string text;
  for (const json& item : list) text += (text.empty() ? "" : " ") + text_of(item);
  return text;
}

/// The part of a path's line between two distances.
std::vector<report::Point> stretch(const json& line, double from, double to, PictureMap& map) {
  std::vector<report::Point> out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double d = line[i][2].get<double>();
    if (d >= from && d <= to) {
      out.push_back(map(line[i]));
      continue;
    }
    if (i + 1 == line.size()) break;
    const double e = line[i + 1][2].get<double>();
    for (const double at : {from, to}) {
      if (!(d < at && at < e)) continue;
      const double u = (at - d) / (e - d);
      const auto a = map(line[i]), b = map(line[i + 1]);
      out.push_back({a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)});
    }
  }
  return out;
}

struct Reader {
  report::GeorefReport& r;
  PictureMap map;
  std::vector<std::pair<double, std::vector<std::string>>> doubts;  // by probability of the path taken

  void journey(int recording, const std::string& name, const json& j) {
    report::GeorefJourney out{.recording = recording, .journey = j.value("journey", 1)};
    const std::string numbers[] = {fmt::format("{}", recording), fmt::format("{}", out.journey)};
    const json paths = j.value("paths", json::array());
    for (const json& p : paths) out.paths.push_back(map.line(p.value("line", json::array())));
    for (const json& s : j.value("switches", json::array())) {
      r.switches.rows.push_back({numbers[0], numbers[1], number(s, "time_s", "{:.3f}"),
                                 number(s, "distance_m", "{:.1f}"), text_of(s.value("from", json())),
                                 text_of(s.value("to", json())), number(s, "probability", "{:.4f}")});
    }
    for (const json& a : j.value("ambiguous", json::array())) {
      const double from = a.value("from_m", 0.0), to = a.value("to_m", 0.0);
      if (!paths.empty()) out.ambiguous.push_back(stretch(paths[0].value("line", json::array()), from, to, map));
      const json e = a.value("evidence", json::object());
      doubts.push_back(
          {-a.value("probability", 0.0),
           {numbers[0], numbers[1], fmt::format("{:.1f} - {:.1f}", a.value("from_s", 0.0), a.value("to_s", 0.0)),
            fmt::format("{:.1f} - {:.1f}", from, to), number(a, "probability", "{:.4f}"),
            joined(a.value("taken", json::array())), joined(a.value("alternative", json::array())),
            number(e, "position", "{:.2f}"), number(e, "speed", "{:.2f}"), number(e, "turn_rate", "{:.2f}"),
            number(e, "route", "{:.2f}")}});
    }
    const double duration = j.value("to_s", 0.0) - j.value("from_s", 0.0);
    r.table.rows.push_back({numbers[0], name, numbers[1], number(j, "from_s", "{:.3f}"),
                            fmt::format("{:.3f}", duration), number(j, "length_m", "{:.3f}"),
                            paths.empty() ? "" : number(paths[0], "probability", "{:.4f}"),
                            fmt::format("{}", paths.size()), number(j, "entropy_nat", "{:.3f}"),
                            number(j, "fixes", "{:.0f}"), number(j, "rejected", "{:.0f}"), "", ""});
    r.journeys.push_back(std::move(out));
  }

  void recording(int index, const json& rec) {
    const std::string name = rec.value("name", "");
    if (rec.contains("error")) r.failed.rows.push_back({name, text_of(rec["error"])});
    for (const json& f : rec.value("findings", json::array())) {
      r.facts.findings.rows.push_back({text_of(f.value("sensor", json())), text_of(f.value("kind", json())),
                                       number(f, "from_s", "{:.3f}"), number(f, "to_s", "{:.3f}"),
                                       text_of(f.value("count", json())), text_of(f.value("action", json())),
                                       name + ": " + text_of(f.value("detail", json()))});
    }
    for (const json& j : rec.value("journeys", json::array())) journey(index, name, j);
  }
};

/// Speeds and sigmas along each journey, and their summary in its row.
Expected<void> read_positions(const std::filesystem::path& folder, report::GeorefReport& r) {
  const auto raw = read_raw(folder / "positions.csv");
  if (!raw) return tl::unexpected(raw.error());
  std::map<std::pair<std::string, std::string>, std::size_t> index;
  for (std::size_t k = 0; k < r.table.rows.size(); ++k) index[{r.table.rows[k][0], r.table.rows[k][2]}] = k;
  const bool speeds = raw->has("sigma_speed_mps");
  for (std::size_t i = 0; i < raw->rows.size(); ++i) {
    const auto it = index.find({raw->at(i, "recording"), raw->at(i, "journey")});
    if (it == index.end()) continue;
    report::GeorefJourney& j = r.journeys[it->second];
    const double t = raw->number(i, "time_s");
    j.time.push_back(t - r.table.number(it->second, "from_s"));
    j.distance.push_back(raw->number(i, "path_distance_m"));
    j.speed.push_back(raw->number(i, "speed_mps") / units::kmh);
    if (speeds) j.sigma_speed.push_back(raw->number(i, "sigma_speed_mps") / units::kmh);
    j.sigma.push_back(raw->number(i, "sigma_m"));
  }
  for (std::size_t k = 0; k < r.journeys.size(); ++k) {
    double sum = 0.0, worst = 0.0;
    const auto& sigma = r.journeys[k].sigma;
    if (sigma.empty()) continue;
    for (const double s : sigma) {
      sum += s;
      worst = std::max(worst, s);
    }
    r.table.rows[k][11] = fmt::format("{:.3f}", sum / static_cast<double>(sigma.size()));
    r.table.rows[k][12] = fmt::format("{:.3f}", worst);
  }
  return {};
}

}  // namespace

Expected<report::GeorefReport> read_georef_report(const std::filesystem::path& folder, const json& run) {
  report::GeorefReport r;
  r.facts = read_facts(folder, run);
  r.facts.findings.rows.clear();  // georef.json has them with the name of their recording
  const auto index = read_json(folder / "georef.json");
  if (!index) return tl::unexpected(index.error());
  const std::string format = index->value("format", "");
  if (format != "versine-georef 1") {
    return fail({.file = (folder / "georef.json").string(),
                 .field = "format",
                 .found = "'" + format + "'",
                 .expected = "'versine-georef 1'",
                 .advice = "run the job again with this version of Versine"});
  }
  r.table.header = {"recording", "name",        "journey", "from_s",   "duration_s",   "length_m",     "probability",
                    "paths",     "entropy_nat", "fixes",   "rejected", "sigma_mean_m", "sigma_worst_m"};
  r.failed.header = {"name", "error"};
  r.switches.header = {"recording", "journey", "time_s", "distance_m", "from", "to", "probability"};
  r.ambiguous.header = {"recording",   "journey",  "span_s", "span_m",    "probability", "taken",
                        "alternative", "position", "speed",  "turn_rate", "route"};
  const json network = index->value("network", json::object());
  r.network = std::filesystem::path(network.value("file", "")).filename().string();
  r.tracks = text_of(network.value("tracks", json()));
  for (const json& w : network.value("warnings", json::array())) r.facts.warnings.push_back(text_of(w));
  Reader reader{r, {}, {}};
  int number = 0;
  for (const json& rec : index->value("recordings", json::array())) reader.recording(++number, rec);
  std::stable_sort(reader.doubts.begin(), reader.doubts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [probability, row] : reader.doubts) r.ambiguous.rows.push_back(std::move(row));
  if (const std::string name = network.value("geojson", ""); !name.empty()) {
    const auto lines = read_json(folder / name);
    if (!lines) return tl::unexpected(lines.error());
    for (const json& feature : lines->value("features", json::array())) {
      const json geometry = feature.value("geometry", json::object());
      const json points = geometry.value("coordinates", json::array());
      if (geometry.value("type", "") == "LineString") r.lines.push_back(reader.map.line(points));
      if (geometry.value("type", "") != "MultiLineString") continue;
      for (const json& line : points) r.lines.push_back(reader.map.line(line));
    }
  }
  if (auto done = read_positions(folder, r); !done) return tl::unexpected(done.error());
  return r;
}

}  // namespace versine::app
