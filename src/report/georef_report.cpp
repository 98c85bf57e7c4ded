// SPDX-License-Identifier: Apache-2.0
#include "versine/report/georef_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "colours.hpp"
#include "versine/report/map.hpp"
#include "versine/report/strip.hpp"

namespace versine::report {

namespace {

using colours::muted;
constexpr std::uint32_t taken_colour = colours::accent, other_colour = 0xc25e00, doubt_colour = colours::bad;

void add_network(MapView& view, const GeorefReport& r, bool frames) {
  for (const auto& line : r.lines) view.lines.push_back({line, {0xc3c9d0, 0.15, Dash::solid}, frames});
}

void add_paths(MapView& view, const GeorefJourney& j, bool others) {
  for (std::size_t k = others ? j.paths.size() : std::min<std::size_t>(1, j.paths.size()); k-- > 0;) {
    view.lines.push_back(
        {j.paths[k], k == 0 ? Pen{taken_colour, 0.7, Dash::solid} : Pen{other_colour, 0.5, Dash::dashed}, true});
  }
  for (const auto& stretch : j.ambiguous) view.lines.push_back({stretch, {doubt_colour, 1.1, Dash::solid}, true});
  if (!j.paths.empty() && !j.paths[0].empty()) view.marks.push_back({j.paths[0].front()});
}

/// How many lines of the network cross a frame around the paths; far ones only cost size.
void keep_near(MapView& view) {
  double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
  for (const MapLine& l : view.lines) {
    if (!l.frames) continue;
    for (const Point& p : l.points) {
      low_x = std::min(low_x, p.x), high_x = std::max(high_x, p.x);
      low_y = std::min(low_y, p.y), high_y = std::max(high_y, p.y);
    }
  }
  const double room = 0.6 * std::max({high_x - low_x, high_y - low_y, 100.0});
  std::erase_if(view.lines, [&](const MapLine& l) {
    return !l.frames && std::none_of(l.points.begin(), l.points.end(), [&](const Point& p) {
      return p.x > low_x - room && p.x < high_x + room && p.y > low_y - room && p.y < high_y + room;
    });
  });
}

void draw_state(Drawing& d, const Box& box, const GeorefReport& r, const Texts& t) {
  const bool failed = !r.failed.rows.empty(), doubt = !r.ambiguous.rows.empty();
  const std::uint32_t colour = failed ? colours::bad : doubt ? colours::doubt : colours::good;
  d.rectangle(box,
              Fill{failed  ? colours::bad_fill
                   : doubt ? colours::doubt_fill
                           : colours::good_fill},
              Pen{colour, 0.5, Dash::solid});
  d.rectangle({box.x, box.y, 3.0, box.height}, Fill{colour});
  d.text({box.x + 7.0, box.y + 8.2},
         t(failed  ? "georef.failed"
           : doubt ? "georef.ambiguous"
                   : "georef.clear"),
         {.size = 5.0, .bold = true, .colour = colour});
  std::string detail = t("georef.clear_detail");
  std::set<std::string> journeys;
  for (std::size_t i = 0; i < r.ambiguous.rows.size(); ++i) {
    journeys.insert(r.ambiguous.at(i, "recording") + "/" + r.ambiguous.at(i, "journey"));
  }
  if (doubt) {
    detail = fmt::format(fmt::runtime(t("georef.ambiguous_detail")), r.ambiguous.rows.size(), journeys.size(),
                         r.journeys.size());
  }
  if (failed) {
    std::set<std::string> good;
    for (std::size_t i = 0; i < r.table.rows.size(); ++i) good.insert(r.table.at(i, "recording"));
    detail =
        fmt::format(fmt::runtime(t("georef.failed_detail")), r.failed.rows.size(), r.failed.rows.size() + good.size());
  }
  d.text({box.x + 7.0, box.y + 14.0}, fitted(detail, box.width - 10.0, 2.9), {.size = 2.9});
}

double total(const RawTable& table, const std::string& column) {
  double sum = 0.0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double v = table.number(i, column);
    if (std::isfinite(v)) sum += v;
  }
  return sum;
}

void add_cover(Pages& pages, const GeorefReport& r, const Texts& t) {
  const Box box = pages.begin("cover", t("cover.title"));
  Drawing& d = pages.page();
  d.text({box.x, box.y + 8.0}, t("cover.georef"), {.size = 7.0, .bold = true});
  d.text({box.x, box.y + 15.0}, fitted(subject_of(r.facts), 118.0, 4.0), {.size = 4.0, .colour = muted});
  std::set<std::string> recordings;
  for (std::size_t i = 0; i < r.table.rows.size(); ++i) recordings.insert(r.table.at(i, "recording"));
  const std::vector<std::pair<std::string, std::string>> rows{
      {t("georef.recordings"), fmt::format("{}", recordings.size() + r.failed.rows.size())},
      {t("georef.journeys"), fmt::format("{}", r.journeys.size())},
      {t("georef.length"), fmt::format("{:.3f} km", 1e-3 * total(r.table, "length_m"))},
      {t("georef.fixes"), fmt::format("{:.0f}", total(r.table, "fixes"))},
      {t("georef.rejected"), fmt::format("{:.0f}", total(r.table, "rejected"))},
      {t("georef.network"), r.network},
      {t("georef.tracks"), r.tracks},
      {t("cover.remarks"), r.facts.cover.remarks},
      {t("cover.software"),
       fmt::format("Versine {}, versine {}, {}", r.facts.version, r.facts.command, r.facts.started)}};
  draw_state(d, {box.x, box.y + 21.0, 118.0, 19.0}, r, t);
  draw_pairs(d, {box.x, box.y + 46.0, 118.0, 0.0}, rows, 34.0, 2.9);
  MapView view{.caption = "WGS84"};
  add_network(view, r, false);
  for (const GeorefJourney& j : r.journeys) add_paths(view, j, false);
  keep_near(view);
  draw_map(d, {box.x + 124.0, box.y + 1.0, box.right() - 124.0, box.height - 8.0}, view);
  d.text({box.x + 124.0, box.bottom() - 2.5}, t("georef.map_note"), {.size = 2.2, .colour = muted});
}

void add_table(Pages& pages, const GeorefReport& r, const Texts& t) {
  pages.begin("journeys", t("georef.journeys_title"));
  Table table{.id = "journeys", .notes = {t("georef.journeys_note")}, .empty = t("inputs.none")};
  table.columns = {{t("georef.recording")},   {t("inputs.file"), Anchor::start, true},
                   {t("georef.journey")},     {t("georef.start")},
                   {t("georef.duration")},    {t("georef.length_m")},
                   {t("georef.probability")}, {t("georef.paths")},
                   {t("georef.entropy")},     {t("georef.fixes")},
                   {t("georef.rejected")},    {t("georef.sigma_mean")},
                   {t("georef.sigma_worst")}};
  table.rows = cells_of(r.table, {"recording", "name", "journey", "from_s", "duration_s", "length_m", "probability",
                                  "paths", "entropy_nat", "fixes", "rejected", "sigma_mean_m", "sigma_worst_m"});
  const double y = pages.add(table);
  if (r.failed.rows.empty()) return;
  Table failed{.id = "failed", .title = t("georef.failed")};
  failed.columns = {{t("inputs.file"), Anchor::start, true, 0.6}, {t("georef.error"), Anchor::start, true, 1.4}};
  failed.rows = cells_of(r.failed, {"name", "error"});
  pages.add(failed, y + 6.0);
}

/// Way on the path at a time of the journey, m; linear between positions.
double distance_at(const GeorefJourney& j, double time) {
  const auto it = std::lower_bound(j.time.begin(), j.time.end(), time);
  if (it == j.time.end()) return j.distance.back();
  const auto i = static_cast<std::size_t>(it - j.time.begin());
  if (i == 0) return j.distance.front();
  const double share = (time - j.time[i - 1]) / (j.time[i] - j.time[i - 1]);
  return j.distance[i - 1] + share * (j.distance[i] - j.distance[i - 1]);
}

void add_journeys(Pages& pages, const GeorefReport& r, const Texts& t) {
  bool first = true;
  for (const GeorefJourney& j : r.journeys) {
    if (j.time.size() < 2) continue;
    const Box box = first ? pages.begin("maps", t("georef.journeys_title")) : pages.next();
    first = false;
    Drawing& d = pages.page();
    d.text({box.x, box.y + 3.4}, fmt::format(fmt::runtime(t("georef.journey_title")), j.recording, j.journey),
           {.size = 3.4, .bold = true});
    d.text({box.right(), box.y + 3.2}, t("georef.map_note"), {.size = 2.2, .anchor = Anchor::end, .colour = muted});
    MapView view{.caption = "WGS84"};
    add_network(view, r, false);
    add_paths(view, j, true);
    keep_near(view);
    draw_map(d, {box.x, box.y + 6.0, box.width, box.height - 62.0}, view);
    std::vector<Strip> strips(2);
    strips[0] = {.name = t("georef.speed"), .detail = t("georef.speed_detail")};
    strips[0].curves.push_back({j.speed, j.sigma_speed});
    strips[1] = {.name = t("georef.sigma"), .detail = t("georef.sigma_detail"), .decimals = 2};
    strips[1].curves.push_back({j.sigma, {}, 0x7a3e9d});
    for (Strip& s : strips) fit_scale(s);
    StripAxis axis{.x = j.time, .from = j.time.front(), .to = j.time.back(), .span = j.time.back() - j.time.front()};
    axis.posted = [](double s) { return s; };
    axis.label = [&](double s) { return fmt::format("{:.0f} s \xC2\xB7 {:.2f} km", s, 1e-3 * distance_at(j, s)); };
    draw_strips(d, {box.x, box.bottom() - 53.0, box.width, 53.0}, strips, axis);
  }
}

void add_doubts(Pages& pages, const GeorefReport& r, const Texts& t) {
  pages.begin("ambiguous", t("georef.ambiguous_title"));
  Table table{.id = "ambiguous", .notes = {t("georef.ambiguous_note")}, .empty = t("georef.ambiguous_none")};
  table.columns = {{t("georef.recording")},
                   {t("georef.journey")},
                   {t("georef.span_s")},
                   {t("georef.span_m")},
                   {"P"},
                   {t("georef.taken"), Anchor::start, true},
                   {t("georef.alternative"), Anchor::start, true},
                   {t("georef.position")},
                   {t("georef.speed")},
                   {t("georef.turn_rate")},
                   {t("georef.route")}};
  table.rows = cells_of(r.ambiguous, {"recording", "journey", "span_s", "span_m", "probability", "taken", "alternative",
                                      "position", "speed", "turn_rate", "route"});
  double y = pages.add(table);
  Table switches{
      .id = "switches", .title = t("georef.switches_title"), .empty = t("georef.switches_none"), .blocks = 2};
  switches.columns = {{t("georef.recording")},
                      {t("georef.journey")},
                      {t("georef.time")},
                      {t("georef.distance")},
                      {t("georef.from_track"), Anchor::start, true},
                      {t("georef.to_track"), Anchor::start, true},
                      {"P"}};
  switches.rows = cells_of(r.switches, {"recording", "journey", "time_s", "distance_m", "from", "to", "probability"});
  pages.add(switches, y + 6.0);
}

}  // namespace

Document georef_document(const GeorefReport& r, const Texts& t) {
  Document d{.title = t("cover.georef"), .subject = subject_of(r.facts), .created = r.facts.started};
  d.language = t.language();
  d.footer = t("footer.georef");
  d.source = fmt::format("{}: {} \xC2\xB7 Versine {} \xC2\xB7 {} \xC2\xB7 {}", t("footer.source"), r.facts.folder,
                         r.facts.version, r.facts.started, r.network);
  Pages pages(d);
  add_cover(pages, r, t);
  add_table(pages, r, t);
  add_doubts(pages, r, t);
  add_journeys(pages, r, t);
  add_record(pages, r.facts, t);
  add_inputs(pages, r.facts, t);
  finish(d, t);
  return d;
}

}  // namespace versine::report
