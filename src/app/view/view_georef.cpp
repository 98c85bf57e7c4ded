// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_georef.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "review.hpp"
#include "versine/core/units.hpp"
#include "versine/io/input_stream.hpp"
#include "view_georef_difference.hpp"
#include "view_georef_series.hpp"
#include "view_map.hpp"
#include "view_survey_parts.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr const char* format = "versine-georef 1";

/// A line of longitude, latitude and path distance in the map's metres.
json projected(const json& line, const geodesy::Projection& projection) {
  json x = json::array(), easting = json::array(), northing = json::array();
  for (const json& p : line) {
    const double longitude = p.at(0).get<double>(), latitude = p.at(1).get<double>();
    const auto map = projection.forward({latitude * units::deg, longitude * units::deg, 0.0});
    x.push_back(p.at(2));
    easting.push_back(std::round(1e3 * map.easting) * 1e-3);
    northing.push_back(std::round(1e3 * map.northing) * 1e-3);
  }
  return {{"x", std::move(x)}, {"easting", std::move(easting)}, {"northing", std::move(northing)}};
}

json hypothesis(const json& path, const geodesy::Projection& projection) {
  json out = projected(path.at("line"), projection);
  out["path"] = path.at("path");
  out["probability"] = path.at("probability");
  out["logLikelihood"] = path.at("log_likelihood");
  out["evidence"] = path.value("evidence", json::object());
  out["from"] = path.at("from_m");
  out["to"] = path.at("to_m");
  out["tracks"] = json::array();
  for (const json& t : path.at("tracks")) {
    out["tracks"].push_back(
        {{"id", t.at("id")}, {"line", t.value("line", t.at("id"))}, {"from", t.at("from_m")}, {"to", t.at("to_m")}});
  }
  return out;
}

json stretch(const json& s) {
  return {{"from", s.at("from_s")},
          {"to", s.at("to_s")},
          {"fromM", s.at("from_m")},
          {"toM", s.at("to_m")},
          {"taken", s.at("taken")},
          {"alternative", s.at("alternative")},
          {"paths", s.at("paths")},
          {"probability", s.at("probability")},
          {"evidence", s.value("evidence", json::object())}};
}

json journey(const json& j, const std::string& id, const std::string& recording, std::size_t count,
             const geodesy::Projection& projection) {
  json out{{"id", id},
           {"recording", recording},
           {"number", j.at("journey")},
           {"from", j.at("from_s")},
           {"to", j.at("to_s")},
           {"length", j.at("length_m")},
           {"count", count},
           {"fixes", j.value("fixes", 0)},
           {"rejected", j.value("rejected", 0)},
           {"entropy", j.value("entropy_nat", 0.0)}};
  out["hypotheses"] = json::array();
  for (const json& p : j.at("paths")) out["hypotheses"].push_back(hypothesis(p, projection));
  out["stretches"] = json::array();
  for (const json& s : j.value("ambiguous", json::array())) out["stretches"].push_back(stretch(s));
  std::stable_sort(out["stretches"].begin(), out["stretches"].end(), [](const json& a, const json& b) {
    return a["probability"].get<double>() > b["probability"].get<double>();
  });
  return out;
}

/// A finished georeferencing, ready to be asked by several threads.
struct GeorefView {
  fs::path folder;
  std::string crs;
  ViewNetwork network;
  std::map<std::string, JourneySeries> journeys;
  std::string text;
};

json verdict_of(const json& journeys, std::size_t failed) {
  std::size_t ambiguous = 0;
  for (const json& j : journeys) ambiguous += j["stretches"].empty() ? 0 : 1;
  std::string text =
      fmt::format("{} journey{} · {} ambiguous", journeys.size(), journeys.size() == 1 ? "" : "s", ambiguous);
  if (failed > 0) text += fmt::format(" · {} recording{} failed", failed, failed == 1 ? "" : "s");
  return {{"accepted", failed > 0 ? json(false) : json(nullptr)}, {"text", text}};
}

Error unusable(const fs::path& file, std::string found) {
  return {.file = file.string(),
          .found = std::move(found),
          .expected = fmt::format("'{}', as this version writes it", format),
          .advice = "run versine georef again with this version, or open the result with the version that wrote it"};
}

std::string id_of(std::size_t recording, const json& journey) {
  return fmt::format("{}.{}", recording, journey.at("journey").get<int>());
}

/// When each journey begins.
std::map<std::string, double> begins(const json& recordings) {
  std::map<std::string, double> out;
  std::size_t number = 0;
  for (const json& r : recordings) {
    ++number;
    for (const json& j : r.value("journeys", json::array())) out[id_of(number, j)] = j.at("from_s").get<double>();
  }
  return out;
}

Expected<json> read_index(const fs::path& folder) {
  const fs::path file = folder / "georef.json";
  const auto text = io::read_text(file);
  if (!text) return tl::unexpected(text.error());
  json index = json::parse(*text, nullptr, false);
  if (index.is_object() && index.value("format", "") == format) return index;
  return tl::unexpected(unusable(file, index.is_object() ? index.value("format", "no format") : "no JSON"));
}

/// Every journey of a result; `count` tells how many positions one has.
json journeys_of(const json& index, const geodesy::Projection& projection,
                 const std::function<std::size_t(const std::string& id)>& count) {
  json out = json::array();
  std::size_t number = 0;
  for (const json& r : index.at("recordings")) {
    ++number;
    const std::string name = r.value("name", fmt::format("recording {}", number));
    for (const json& j : r.value("journeys", json::array())) {
      const std::string id = id_of(number, j);
      out.push_back(journey(j, id, name, count(id), projection));
    }
  }
  return out;
}

std::string title_of(const fs::path& folder) {
  const auto text = io::read_text(folder / "run.json");
  const json run = text ? json::parse(*text, nullptr, false) : json();
  const std::string title = run.is_object() ? run.value("settings", json::object()).value("title", "") : "";
  return title.empty() ? fs::absolute(folder).lexically_normal().filename().string() : title;
}

Expected<std::shared_ptr<GeorefView>> open(const fs::path& folder, const std::string& run_json,
                                           const std::optional<fs::path>& compare) {
  const auto read = read_index(folder);
  if (!read) return tl::unexpected(read.error());
  const json& index = *read;
  const json& network = index.at("network");
  const std::string crs = network.value("crs", "");
  const auto projection = geodesy::Projection::create(crs);
  if (!projection) return tl::unexpected(projection.error());
  auto view = std::make_shared<GeorefView>();
  view->folder = folder;
  view->crs = crs;
  auto map = read_view_network(folder / network.value("geojson", "network.geojson"), *projection);
  if (!map) return tl::unexpected(map.error());
  view->network = std::move(*map);
  auto series = read_journey_series(folder, *projection, begins(index.at("recordings")));
  if (!series) return tl::unexpected(series.error());
  view->journeys = std::move(*series);

  json failures = json::array();
  std::size_t number = 0;
  for (const json& r : index.at("recordings")) {
    ++number;
    if (!r.contains("error")) continue;
    failures.push_back({{"recording", r.value("name", fmt::format("recording {}", number))}, {"error", r["error"]}});
  }
  json journeys = journeys_of(index, *projection, [&](const std::string& id) {
    const auto found = view->journeys.find(id);
    return found == view->journeys.end() ? 0 : found->second.size();
  });
  if (compare) {
    const auto other = read_index(*compare);
    if (!other) return tl::unexpected(other.error());
    add_difference(journeys, journeys_of(*other, *projection, [](const std::string&) { return std::size_t{0}; }));
  }
  const json verdict = verdict_of(journeys, failures.size());
  const std::string subtitle = fmt::format("{} recording{} · map {}", number, number == 1 ? "" : "s",
                                           fs::path(network.value("file", "")).filename().string());
  json georef{{"network",
               {{"tracks", network.value("tracks", view->network.names.size())},
                {"names", view->network.names},
                {"bounds", view->network.bounds},
                {"warnings", network.value("warnings", json::array())}}},
              {"journeys", std::move(journeys)},
              {"failures", std::move(failures)},
              {"strips", georef_strips()},
              {"constraintsFile", constraints_file(folder).filename().string()}};
  if (compare) georef["compare"] = title_of(*compare);
  const SurveyFiles frame{.folder = folder, .run = json::parse(run_json), .results = {}, .settings = {}};
  view->text = view_frame("georef", frame, crs, subtitle, verdict, std::move(georef));
  return view;
}

}  // namespace

fs::path constraints_file(const fs::path& folder) {
  return fs::path(folder).concat(".constraints.toml");
}

Expected<ViewContent> open_georef_view(const fs::path& folder, const std::string& run_json,
                                       const std::optional<fs::path>& compare) {
  Expected<std::shared_ptr<GeorefView>> opened = tl::unexpected(Error{});
  try {
    opened = open(folder, run_json, compare);
  } catch (const json::exception& problem) {  // a key that is missing or of another kind
    return tl::unexpected(unusable(folder / "georef.json", problem.what()));
  }
  if (!opened) return tl::unexpected(opened.error());
  ViewContent content;
  const auto view = *opened;
  content.crs = view->crs;
  content.result_json = [view] { return view->text; };
  content.series = [view](const std::string& id, double from, double to,
                          std::size_t buckets) -> std::optional<std::string> {
    const auto at = id.find(':');
    const auto found = view->journeys.find(id.substr(0, at));
    if (at == std::string::npos || found == view->journeys.end()) return std::nullopt;
    return found->second.encode(id.substr(at + 1), from, to, buckets);
  };
  content.map = [view](const std::string& part) -> std::optional<std::string> {
    if (part.size() == 1 && part[0] >= '0' && part[0] <= '2') {
      return view->network.levels[static_cast<std::size_t>(part[0] - '0')];
    }
    const auto found = view->journeys.find(part);
    return found == view->journeys.end() ? std::nullopt : std::optional(found->second.fixes());
  };
  content.constraints_json = [view] {
    const auto text = load_review(constraints_file(view->folder));
    return text ? *text : std::string("[]");
  };
  content.put_constraints = [view](const std::string& text) {
    return save_review(constraints_file(view->folder), text);
  };
  content.report = report_of(folder);
  return content;
}

}  // namespace versine::app
