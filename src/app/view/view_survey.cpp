// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "job/text_table.hpp"
#include "versine/core/calendar.hpp"
#include "versine/io/input_stream.hpp"
#include "view_difference.hpp"
#include "view_packup.hpp"
#include "view_survey_parts.hpp"
#include "view_trajectory.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

TimeScale scale_of(const json& run) {
  const std::string text = run.value("time_scale", "");
  return text.starts_with("GPS") ? TimeScale::gps : text.starts_with("UTC") ? TimeScale::utc : TimeScale::recorder;
}

/// A finished survey whose columns are read when they are first looked at, a tab at a time.
class SurveyView {
 public:
  static Expected<std::shared_ptr<SurveyView>> open(SurveyFiles files, const std::optional<fs::path>& compare);
  [[nodiscard]] const std::string& json_text() const { return text_; }
  [[nodiscard]] std::optional<std::string> series(const std::string& id, double from, double to, std::size_t buckets);
  [[nodiscard]] std::string values(double x);

 private:
  Expected<void> load_grid();
  Expected<void> load_tab(const std::string& tab);
  Expected<void> describe(const std::optional<fs::path>& compare);
  [[nodiscard]] json strip_json(const ViewStrip& strip, const std::map<std::string, json>& limits) const;
  [[nodiscard]] std::string subtitle() const;

  explicit SurveyView(SurveyFiles files, io::GeometryTable table)
      : files_(std::move(files)), table_(std::move(table)) {}
  SurveyFiles files_;
  io::GeometryTable table_;
  SurveyGrid grid_;
  std::vector<ViewStrip> strips_;
  std::map<std::string, ViewSeries> series_;
  std::map<std::string, bool> loaded_;  // tabs
  std::mutex mutex_;
  std::string text_;
};

Expected<std::shared_ptr<SurveyView>> SurveyView::open(SurveyFiles files, const std::optional<fs::path>& compare) {
  auto table = io::GeometryTable::open(files.folder / "geometry.csv");
  if (!table) return tl::unexpected(table.error());
  std::shared_ptr<SurveyView> view(new SurveyView(std::move(files), std::move(*table)));
  if (view->table_.rows() == 0) {
    return fail({.file = (view->files_.folder / "geometry.csv").string(),
                 .found = "no line of data",
                 .expected = "at least one point of track",
                 .advice = "run the job again; 'versine check' tells whether the run meets its design"});
  }
  view->strips_ = geometry_strips(view->table_.columns(), view->files_.settings);
  if (auto done = view->load_grid(); !done) return tl::unexpected(done.error());
  if (auto done = view->load_tab("strips"); !done) return tl::unexpected(done.error());
  if (auto done = view->describe(compare); !done) return tl::unexpected(done.error());
  return view;
}

Expected<void> SurveyView::load_grid() {
  std::vector<std::string> names = {"distance_m", "mileage_m", "time_s", "flags"};
  for (const char* name : {"easting_axis_m", "northing_axis_m"}) {
    if (table_.has(name)) names.emplace_back(name);
  }
  auto columns = table_.read(names);
  if (!columns) return tl::unexpected(columns.error());
  columns->resize(6, std::vector<double>(table_.rows(), std::numeric_limits<double>::quiet_NaN()));
  grid_.x = std::make_shared<const std::vector<double>>(std::move((*columns)[0]));
  grid_.mileage = std::move((*columns)[1]);
  grid_.time_s = std::move((*columns)[2]);
  grid_.flags = std::move((*columns)[3]);
  grid_.easting = std::move((*columns)[4]);
  grid_.northing = std::move((*columns)[5]);
  if (!std::is_sorted(grid_.x->begin(), grid_.x->end())) {
    return fail({.file = (files_.folder / "geometry.csv").string(),
                 .field = "distance_m",
                 .found = "distances that do not increase",
                 .expected = "the table as Versine wrote it",
                 .advice = "run the job again"});
  }
  return {};
}

Expected<void> SurveyView::load_tab(const std::string& tab) {
  std::vector<std::string> names;
  const auto want = [&](const std::string& id) {
    if (id.empty() || series_.contains(id) || std::find(names.begin(), names.end(), id) != names.end()) return;
    names.push_back(id);
    if (table_.has("sigma_" + id)) names.push_back("sigma_" + id);
  };
  for (const ViewStrip& s : strips_) {
    if (s.tab != tab) continue;
    want(s.id);
    want(s.companion);
  }
  auto columns = table_.read(names);
  if (!columns) return tl::unexpected(columns.error());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool sigma = k + 1 < names.size() && names[k + 1].starts_with("sigma_");
    series_.emplace(names[k], ViewSeries(grid_.x, (*columns)[k], sigma ? (*columns)[k + 1] : std::vector<double>{}));
    if (sigma) ++k;
  }
  loaded_[tab] = true;
  return {};
}

std::string SurveyView::subtitle() const {
  const TimeScale scale = scale_of(files_.run);
  const double length = grid_.x->back() - grid_.x->front();
  std::string out = length < 1000.0 ? fmt::format("{:.0f} m", length) : fmt::format("{:.1f} km", 1e-3 * length);
  const json quality = files_.results.value("quality", json::object());
  if (quality.contains("speed_kmh")) out += fmt::format(" · {:.0f} km/h", quality["speed_kmh"].get<double>());
  const auto [first, last] = std::minmax_element(grid_.time_s.begin(), grid_.time_s.end());
  if (scale != TimeScale::recorder && std::isfinite(*first)) {
    out += fmt::format(" · {} to {}{}", to_text(Time::from_seconds(std::floor(*first)), scale).substr(0, 16),
                       to_text(Time::from_seconds(std::floor(*last)), scale).substr(11, 5),
                       scale == TimeScale::gps ? " GPS" : "");
  }
  return out;
}

json SurveyView::strip_json(const ViewStrip& s, const std::map<std::string, json>& limits) const {
  const auto found = limits.find(s.id);
  const auto loaded = series_.find(s.id);
  const bool own = loaded != series_.end();
  json out{{"id", s.id},
           {"title", s.title},
           {"note", s.note},
           {"unit", s.unit},
           {"positive", s.positive},
           {"digits", s.digits},
           {"tab", s.tab},
           {"count", own ? loaded->second.size() : table_.rows()},
           {"sigma", own ? loaded->second.has_sigma() : table_.has("sigma_" + s.id)},
           {"limits", found == limits.end() ? json::array() : found->second}};
  if (!s.companion.empty()) {
    const auto other = std::find_if(strips_.begin(), strips_.end(), [&](const auto& c) { return c.id == s.companion; });
    out["companion"] = {{"id", s.companion},
                        {"title", "cant"},
                        {"unit", other == strips_.end() ? "" : other->unit},
                        {"digits", other == strips_.end() ? 0 : other->digits}};
  }
  return out;
}

Expected<void> SurveyView::describe(const std::optional<fs::path>& compare) {
  const auto exceedances = exceedances_of(files_, strips_);
  if (!exceedances) return tl::unexpected(exceedances.error());
  const auto control = control_points_of(files_, grid_);
  if (!control) return tl::unexpected(control.error());
  auto adjustment = adjustment_of(files_, grid_);
  if (!adjustment) return tl::unexpected(adjustment.error());
  for (auto& a : *adjustment) {
    series_.emplace(a.strip.id, std::move(a.series));
    strips_.push_back(std::move(a.strip));
  }
  json survey;
  const double first = grid_.x->front(), last = grid_.x->back();
  survey["axis"] = "mileage";
  survey["x"] = {
      {"from", first}, {"to", last}, {"count", grid_.x->size()}, {"step", files_.results.value("step_m", 0.25)}};
  survey["chainage"] = chainage_of(files_, grid_);
  if (compare) {
    auto difference = difference_of(files_, table_, strips_, *compare);
    if (!difference) return tl::unexpected(difference.error());
    survey["compare"] = difference->title;
    for (auto& [id, series] : difference->series) series_.emplace(id, std::move(series));
    strips_.insert(strips_.end(), difference->strips.begin(), difference->strips.end());
  }
  const auto limits = limits_by_column(files_);
  survey["strips"] = json::array();
  for (const ViewStrip& s : strips_) survey["strips"].push_back(strip_json(s, limits));
  survey["tabs"] = json::array();
  for (const ViewTab& tab : view_tabs()) {
    if (std::any_of(strips_.begin(), strips_.end(), [&](const ViewStrip& s) { return s.tab == tab.id; })) {
      survey["tabs"].push_back({{"id", tab.id}, {"title", tab.title}});
    }
  }
  survey["plan"] = plan_of(files_.results.value("crs", ""), *grid_.x, grid_.easting, grid_.northing);
  survey["exceedances"] = *exceedances;
  survey["controlPoints"] = *control;
  survey["packUp"] = pack_up_of(files_, grid_, *grid_.x, *control, *exceedances);
  survey["conventions"] = files_.results.value("conventions", json::object());
  text_ =
      view_frame("survey", files_, files_.results.value("crs", ""), subtitle(), verdict_of(files_), std::move(survey));
  return {};
}

std::optional<std::string> SurveyView::series(const std::string& id, double from, double to, std::size_t buckets) {
  const std::lock_guard lock(mutex_);
  const auto find = [&] { return series_.find(id); };
  if (find() == series_.end()) {
    for (const ViewStrip& s : strips_) {
      // What cannot be read is told by its absence: the page shows the server's words.
      if ((s.id == id || s.companion == id) && !loaded_[s.tab] && !load_tab(s.tab)) return std::nullopt;
    }
  }
  const auto it = find();
  return it == series_.end() ? std::nullopt : std::optional(it->second.encode(from, to, buckets));
}

std::string SurveyView::values(double x) {
  const std::lock_guard lock(mutex_);
  json out = json::object();
  for (const auto& [id, series] : series_) {
    const auto at = series.at(x);
    if (at) out[id] = {number_or_null(at->value), number_or_null(at->sigma)};
  }
  return out.dump();
}

}  // namespace

Expected<ViewContent> open_survey_view(const fs::path& folder, const std::string& run_json,
                                       const std::optional<fs::path>& compare) {
  SurveyFiles files{.folder = folder, .run = json::parse(run_json), .results = {}, .settings = {}};
  const json results = files.run.value("results", json::object());
  files.results = results.contains("geometry") ? results["geometry"] : results;
  files.settings = files.run.value("settings", json::object()).value("geometry", json::object());
  if (!fs::exists(folder / "geometry.csv")) {
    if (compare) {
      return fail({.file = folder.string(),
                   .found = "a result without track geometry",
                   .expected = "geometry.csv in both results that are compared",
                   .advice = "add [geometry] to the job, with write.csv = true, and run it again"});
    }
    return open_trajectory_view(std::move(files));
  }
  const std::string crs = files.results.value("crs", "");
  auto view = SurveyView::open(std::move(files), compare);
  if (!view) return tl::unexpected(view.error());
  ViewContent content;
  content.crs = crs;
  content.result_json = [v = *view] { return v->json_text(); };
  content.series = [v = *view](const std::string& id, double from, double to, std::size_t buckets) {
    return v->series(id, from, to, buckets);
  };
  content.values_json = [v = *view](double x) { return v->values(x); };
  content.report = report_of(folder);
  return content;
}

}  // namespace versine::app
