// SPDX-License-Identifier: Apache-2.0
#include "view_trajectory.hpp"

#include <fmt/format.h>

#include <cmath>

#include "versine/core/calendar.hpp"
#include "versine/core/numbers.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/io/read_recording.hpp"
#include "view_packup.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

struct TrajectoryView {
  std::string text;
  std::vector<std::pair<ViewStrip, ViewSeries>> series;

  [[nodiscard]] const ViewSeries* find(const std::string& id) const {
    for (const auto& [strip, s] : series) {
      if (strip.id == id) return &s;
    }
    return nullptr;
  }
};

struct Quantity {
  ViewStrip strip;
  double (*value)(const geodesy::TrajectoryPoint&);
  double (*sigma)(const geodesy::TrajectoryPoint&);  ///< nullptr: has none
};

double tilt(const geodesy::TrajectoryPoint& p) {
  return std::sqrt(0.5 * double{p.attitude_covariance.xx + p.attitude_covariance.yy}) / units::deg;
}

const std::vector<Quantity>& quantities() {
  using P = geodesy::TrajectoryPoint;
  static const std::vector<Quantity> all = {
      {{.id = "height_m", .title = "Height", .note = "ellipsoidal", .unit = "m", .positive = "+ up", .digits = 3},
       [](const P& p) { return p.position.height; },
       [](const P& p) { return std::sqrt(double{p.position_covariance.zz}); }},
      {{.id = "speed_mps", .title = "Speed", .note = "horizontal", .unit = "m/s", .digits = 2},
       [](const P& p) { return std::hypot(p.v_eb_n.x(), p.v_eb_n.y()); },
       [](const P& p) { return std::sqrt(0.5 * double{p.velocity_covariance.xx + p.velocity_covariance.yy}); }},
      {{.id = "heading_deg",
        .title = "Heading",
        .note = "from north",
        .unit = "°",
        .positive = "+ clockwise",
        .digits = 2},
       [](const P& p) {
         const double heading = geodesy::to_euler(p.q_nb).yaw / units::deg;
         return heading < 0.0 ? heading + 360.0 : heading;
       },
       [](const P& p) { return std::sqrt(double{p.attitude_covariance.zz}) / units::deg; }},
      {{.id = "pitch_deg", .title = "Pitch", .unit = "°", .positive = "+ nose up", .digits = 3},
       [](const P& p) { return geodesy::to_euler(p.q_nb).pitch / units::deg; },
       tilt},
      {{.id = "roll_deg", .title = "Roll", .unit = "°", .positive = "+ right side down", .digits = 3},
       [](const P& p) { return geodesy::to_euler(p.q_nb).roll / units::deg; },
       tilt},
      {{.id = "sigma_horizontal_m", .title = "Sigma", .note = "horizontal, larger axis", .unit = "m", .digits = 4},
       [](const P& p) {
         const double xx = p.position_covariance.xx, yy = p.position_covariance.yy, xy = p.position_covariance.xy;
         return std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
       },
       nullptr},
      {{.id = "sigma_vertical_m", .title = "Sigma", .note = "vertical", .unit = "m", .digits = 4},
       [](const P& p) { return std::sqrt(double{p.position_covariance.zz}); },
       nullptr}};
  return all;
}

json trajectory_plan(const geodesy::Trajectory& track, const std::vector<double>& x, const std::string& crs) {
  const auto projection = geodesy::Projection::create(crs);
  if (!projection) return json::array();
  std::vector<double> at, easting, northing;
  const std::size_t stride = std::max<std::size_t>(1, track.size() / 4000);
  for (std::size_t i = 0; i < track.size(); ++i) {
    const bool begins = i > 0 && track[i].segment != track[i - 1].segment;
    if (begins) {
      at.push_back(x[i]);
      easting.push_back(nan);
      northing.push_back(nan);
    }
    if (i % stride != 0 && i + 1 < track.size() && !begins) continue;
    const auto p = projection->forward(track[i].position);
    at.push_back(x[i]);
    easting.push_back(p.easting);
    northing.push_back(p.northing);
  }
  return plan_of(crs, at, easting, northing);
}

/// Way travelled at each point, m; nothing is travelled between two segments.
std::vector<double> travelled(const geodesy::Trajectory& track) {
  std::vector<double> out;
  out.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    double step = 0.0;
    if (i > 0 && track[i].segment == track[i - 1].segment) {
      step = 0.5 * (track[i].v_eb_n + track[i - 1].v_eb_n).norm() * (track[i].time - track[i - 1].time).seconds();
    }
    out.push_back((out.empty() ? 0.0 : out.back()) + step);
  }
  return out;
}

/// Where fixes and landmarks were measured, of a job that is still running.
json recorded_places(const json& recorded, const std::string& crs) {
  const auto projection = geodesy::Projection::create(crs);
  json out = json::object();
  if (!projection || !recorded.is_object()) return out;
  for (const char* kind : {"fixes", "landmarks"}) {
    json easting = json::array(), northing = json::array();
    for (const json& p : recorded.value(kind, json::array())) {
      const auto map = projection->forward({p.at(0).get<double>() * units::deg, p.at(1).get<double>() * units::deg, 0});
      easting.push_back(number_or_null(map.easting));
      northing.push_back(number_or_null(map.northing));
    }
    out[kind] = {{"easting", std::move(easting)}, {"northing", std::move(northing)}};
  }
  return out;
}

}  // namespace

Expected<ViewContent> open_trajectory_view(SurveyFiles files) {
  io::TrajectoryFile file;
  for (const char* name : {"trajectory.h5", "trajectory.csv"}) {
    if (file.table.path.empty() && fs::exists(files.folder / name)) file.table.path = files.folder / name;
  }
  if (file.table.path.empty()) {
    return fail(
        {.file = files.folder.string(),
         .found = "neither geometry.csv nor trajectory.h5 nor trajectory.csv",
         .expected = "a result with one of them",
         .advice = "switch one on in the job (output.hdf5 = true) and run it again; or the folder was copied in part"});
  }
  auto read = io::read_trajectory(file);
  if (!read) return tl::unexpected(read.error());
  const geodesy::Trajectory& track = read->series;
  auto x = std::make_shared<std::vector<double>>();
  for (const auto& p : track) x->push_back((p.time - track.front().time).seconds());
  auto view = std::make_shared<TrajectoryView>();
  json survey{{"axis", "time"}};
  survey["origin"] = to_text(track.front().time, track.scale);
  survey["x"] = {{"from", 0.0}, {"to", x->back()}, {"count", x->size()}, {"step", x->back() / double(x->size())}};
  survey["chainage"] = json::array();
  survey["strips"] = json::array();
  survey["tabs"] = {{{"id", "strips"}, {"title", "Trajectory"}}};
  for (const Quantity& q : quantities()) {
    std::vector<double> value, sigma;
    for (const auto& p : track) {
      value.push_back(q.value(p));
      if (q.sigma != nullptr) sigma.push_back(q.sigma(p));
    }
    view->series.emplace_back(q.strip, ViewSeries(x, value, sigma));
    survey["strips"].push_back({{"id", q.strip.id},
                                {"title", q.strip.title},
                                {"note", q.strip.note},
                                {"unit", q.strip.unit},
                                {"positive", q.strip.positive},
                                {"digits", q.strip.digits},
                                {"tab", "strips"},
                                {"count", x->size()},
                                {"sigma", q.sigma != nullptr},
                                {"limits", json::array()}});
  }
  const json results = files.run.value("results", json::object());
  const std::string crs = results.value("crs", "");
  survey["plan"] = trajectory_plan(track, *x, crs);
  if (results.contains("recorded")) survey["recorded"] = recorded_places(results["recorded"], crs);
  SurveyGrid grid{.x = x, .mileage = {}, .time_s = {}, .flags = {}, .easting = {}, .northing = {}};
  for (const auto& p : track) grid.time_s.push_back(p.time.seconds());
  const auto control = control_points_of(files, grid);
  if (!control) return tl::unexpected(control.error());
  survey["exceedances"] = json::array();
  survey["controlPoints"] = *control;
  survey["packUp"] = pack_up_of(files, grid, travelled(track), *control, json::array());
  const double length = results.value("length_m", nan);
  const std::string subtitle =
      (std::isfinite(length) ? fmt::format("{:.2f} km · ", 1e-3 * length) : std::string()) +
      fmt::format("{:.0f} min · from {}", x->back() / 60.0, to_text(track.front().time, track.scale).substr(0, 16));
  const std::string partial = results.value("partial", "");
  const std::string verdict = partial.empty() ? "TRAJECTORY ONLY" : "SO FAR · " + partial;
  view->text =
      view_frame("survey", files, crs, subtitle, {{"accepted", nullptr}, {"text", verdict}}, std::move(survey));
  ViewContent content;
  content.crs = crs;
  content.result_json = [view] { return view->text; };
  content.series = [view](const std::string& id, double from, double to,
                          std::size_t buckets) -> std::optional<std::string> {
    const ViewSeries* s = view->find(id);
    return s == nullptr ? std::nullopt : std::optional(s->encode(from, to, buckets));
  };
  content.values_json = [view](double at) {
    json out = json::object();
    for (const auto& [strip, series] : view->series) {
      if (const auto v = series.at(at)) out[strip.id] = {number_or_null(v->value), number_or_null(v->sigma)};
    }
    return out.dump();
  };
  content.report = report_of(files.folder);
  return content;
}

}  // namespace versine::app
