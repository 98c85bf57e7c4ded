// SPDX-License-Identifier: Apache-2.0
#include "view_georef_series.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "job/text_table.hpp"
#include "versine/core/numbers.hpp"
#include "versine/core/units.hpp"
#include "view_map.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// Values of one column of a table, and of the column with its sigma ("" for none), under a name of their own.
struct Wanted {
  const char* name;
  const char* column;
  const char* sigma;
};
constexpr std::array<Wanted, 4> of_positions{{{"speed", "speed_mps", "sigma_speed_mps"},
                                              {"sigma", "sigma_m", ""},
                                              {"distance", "path_distance_m", "sigma_m"},
                                              {"mileage", "mileage_m", ""}}};
constexpr std::array<Wanted, 4> of_fixes{{{"along", "along_m", "sigma_along_m"},
                                          {"across", "across_m", "sigma_across_m"},
                                          {"nis", "nis", ""},
                                          {"gnss", "sigma_m", ""}}};
constexpr std::array<const char*, 4> statuses{"used", "weak", "rejected", "path_only"};

struct Rows {
  JourneySeries::Table table;
  std::vector<std::vector<Eigen::Vector2d>> points;  ///< of fixes, by status
};

std::string key_of(const std::vector<std::string>& row, std::optional<std::size_t> recording,
                   std::optional<std::size_t> journey) {
  return row[*recording] + "." + row[*journey];
}

Expected<std::map<std::string, Rows>> read(const fs::path& path, std::span<const Wanted> wanted,
                                           const std::map<std::string, double>& begin,
                                           const geodesy::Projection* projection) {
  const auto text = TextTable::read(path);
  if (!text) return tl::unexpected(text.error());
  const auto recording = text->find("recording"), journey = text->find("journey"), time = text->find("time_s"),
             distance = text->find("path_distance_m"), latitude = text->find("latitude_deg"),
             longitude = text->find("longitude_deg"), status = text->find("status");
  if (!recording || !journey || !time || !distance) {
    return fail({.file = path.string(),
                 .found = "a table without recording, journey, time_s or path_distance_m",
                 .expected = "the columns of docs/formats-georef.md",
                 .advice = "run versine georef again with this version"});
  }
  std::map<std::string, Rows> out;
  for (const auto& row : text->rows) {
    const std::string key = key_of(row, recording, journey);
    const auto start = begin.find(key);
    if (start == begin.end()) continue;
    Rows& rows = out[key];
    rows.table.time.push_back(TextTable::number(row, time) - start->second);
    rows.table.distance.push_back(TextTable::number(row, distance));
    for (const Wanted& w : wanted) {
      auto& column = rows.table.columns[w.name];
      column.value.push_back(TextTable::number(row, text->find(w.column)));
      if (const auto sigma = text->find(w.sigma)) column.sigma.push_back(TextTable::number(row, sigma));
    }
    if (projection == nullptr || !latitude || !longitude || !status) continue;
    rows.points.resize(statuses.size());
    const auto place = projection->forward(
        {TextTable::number(row, latitude) * units::deg, TextTable::number(row, longitude) * units::deg, 0.0});
    for (std::size_t s = 0; s < statuses.size(); ++s) {
      if (row[*status] == statuses[s] && std::isfinite(place.easting)) {
        rows.points[s].emplace_back(place.easting, place.northing);
      }
    }
  }
  return out;
}

/// Series need places that never go back and are numbers; what has none is left out.
void add(std::map<std::string, ViewSeries>& series, const std::string& axis, const std::vector<double>& x,
         const std::map<std::string, JourneySeries::Column>& columns) {
  std::vector<std::size_t> kept;
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] >= last)) continue;
    last = x[i];
    kept.push_back(i);
  }
  const auto pick = [&](const std::vector<double>& all) {
    std::vector<double> out;
    if (all.empty()) return out;
    out.reserve(kept.size());
    for (const std::size_t i : kept) out.push_back(all[i]);
    return out;
  };
  const auto places = std::make_shared<const std::vector<double>>(pick(x));
  for (const auto& [name, column] : columns) {
    series.emplace(axis + name, ViewSeries(places, pick(column.value), pick(column.sigma)));
  }
}

}  // namespace

JourneySeries::JourneySeries(Table positions, Table fixes, std::string fix_points)
    : size_(positions.time.size()), fixes_(std::move(fix_points)) {
  for (const Table* table : {&positions, &fixes}) {
    add(series_, "t:", table->time, table->columns);
    add(series_, "d:", table->distance, table->columns);
  }
}

std::optional<std::string> JourneySeries::encode(const std::string& id, double from, double to,
                                                 std::size_t buckets) const {
  const auto found = series_.find(id);
  return found == series_.end() ? std::nullopt : std::optional(found->second.encode(from, to, buckets));
}

Expected<std::map<std::string, JourneySeries>> read_journey_series(const fs::path& folder,
                                                                   const geodesy::Projection& projection,
                                                                   const std::map<std::string, double>& begin) {
  auto positions = read(folder / "positions.csv", of_positions, begin, nullptr);
  if (!positions) return tl::unexpected(positions.error());
  auto fixes = read(folder / "fixes.csv", of_fixes, begin, &projection);
  if (!fixes) return tl::unexpected(fixes.error());
  std::map<std::string, JourneySeries> out;
  for (auto& [id, rows] : *positions) {
    Rows& own = (*fixes)[id];
    own.points.resize(statuses.size());
    out.emplace(id, JourneySeries(std::move(rows.table), std::move(own.table), encode_points(own.points)));
  }
  return out;
}

json georef_strips() {
  const auto strip = [](const char* id, const char* title, const char* note, const char* unit, const char* positive,
                        int digits) {
    return json{{"id", id},         {"title", title},   {"note", note}, {"unit", unit},  {"positive", positive},
                {"digits", digits}, {"tab", "journey"}, {"count", 0},   {"sigma", true}, {"limits", json::array()}};
  };
  json out = json::array(
      {strip("speed", "Speed", "smoothed", "m/s", "", 2), strip("sigma", "Sigma", "along the track", "m", "", 2),
       strip("along", "Fix along", "innovation", "m", "+ ahead", 2),
       strip("across", "Fix across", "innovation", "m", "+ right", 2),
       strip("nis", "NIS", "of 2 degrees of freedom", "", "", 1), strip("gnss", "GNSS sigma", "as used", "m", "", 2)});
  // 95 % of a chi-square distribution with two degrees of freedom.
  out[4]["limits"].push_back({{"level", "95 % bound"}, {"class", "AL"}, {"low", nullptr}, {"high", 5.991}});
  return out;
}

}  // namespace versine::app
