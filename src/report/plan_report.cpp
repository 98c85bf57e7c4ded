// SPDX-License-Identifier: Apache-2.0
#include "versine/report/plan_report.hpp"

#include <fmt/format.h>

#include "colours.hpp"
#include "versine/report/strip.hpp"

namespace versine::report {

namespace {

using colours::muted;

/// Figures in rows on one page.
void draw_grid(Drawing& d, const Box& box, const std::vector<Figure>& figures, int columns) {
  const int rows = (static_cast<int>(figures.size()) + columns - 1) / columns;
  if (rows == 0) return;
  const double width = box.width / columns, height = box.height / rows;
  for (int k = 0; k < static_cast<int>(figures.size()); ++k) {
    draw(d, {box.x + width * (k % columns), box.y + height * (k / columns), width - 3.0, height - 3.0},
         figures[static_cast<std::size_t>(k)]);
  }
}

void add_cover(Pages& pages, const PlanReport& r, const Texts& t) {
  const Box box = pages.begin("cover", t("cover.title"));
  Drawing& d = pages.page();
  d.text({box.x, box.y + 8.0}, t("cover.plan"), {.size = 7.0, .bold = true});
  d.text({box.x, box.y + 15.0}, fitted(subject_of(r.facts), 130.0, 4.2), {.size = 4.2, .colour = muted});
  const std::uint32_t colour = r.met ? colours::good : colours::bad;
  const Box state{box.x + 140.0, box.y + 1.0, box.width - 140.0, 19.0};
  d.rectangle(state, Fill{r.met ? colours::good_fill : colours::bad_fill}, Pen{colour, 0.5, Dash::solid});
  d.rectangle({state.x, state.y, 3.0, state.height}, Fill{colour});
  d.text({state.x + 7.0, state.y + 8.2}, t(r.met ? "plan.met" : "plan.not_met"),
         {.size = 5.2, .bold = true, .colour = colour});
  d.text({state.x + 7.0, state.y + 14.2}, fmt::format(fmt::runtime(t("plan.detail")), r.sigma_mm, r.required_mm),
         {.size = 3.0});
  Table sensors{.id = "sensors", .title = t("plan.how"), .empty = ""};
  sensors.columns = {{t("inputs.key"), Anchor::start, true}, {t("inputs.value"), Anchor::start, true}};
  sensors.rows = cells_of(r.sensors, {"key", "value"});
  sensors.blocks = 2;
  Table answers{.id = "answers", .title = t("plan.answers"), .empty = ""};
  answers.columns = {{t("plan.question"), Anchor::start, true, 2.0}, {t("plan.answer"), Anchor::end, false, 1.0, 40.0}};
  for (std::size_t i = 0; i < r.answers.rows.size(); ++i) {
    const std::string& value = r.answers.at(i, "answer");
    answers.rows.push_back({{t(r.answers.at(i, "question"))}, {value.empty() ? t("plan.none") : value}});
  }
  double y = pages.add(answers, box.y + 26.0);
  pages.add(sensors, y + 6.0);
}

void add_tables(Pages& pages, const PlanReport& r, const Texts& t) {
  pages.begin("instruments", t("plan.grades"));
  Table grades{.id = "grades", .title = t("plan.grades"), .empty = t("inputs.none")};
  grades.columns = {{t("plan.grade"), Anchor::start, false, 1.0, 45.0},
                    {t("plan.grade_sigma"), Anchor::end, false, 1.0, 35.0},
                    {t("plan.grade_spacing"), Anchor::end, false, 1.0, 35.0}};
  grades.rows = cells_of(r.grades, {"name", "sigma_mm", "largest_spacing_m"});
  double y = pages.add(grades);
  if (r.method_table.rows.empty()) return;
  Table methods{.id = "methods", .title = t("plan.methods")};
  methods.columns = {{t("plan.method"), Anchor::start, false, 1.0, 60.0},
                     {t("plan.lateral") + ", mm"},
                     {t("plan.vertical") + ", mm"},
                     {t("plan.longitudinal") + ", mm"}};
  methods.rows = cells_of(r.method_table, {"name", "lateral_mm", "vertical_mm", "longitudinal_mm"});
  pages.add(methods, y + 6.0);
}

void add_figures(Pages& pages, const char* id, const std::string& title, const std::vector<Figure>& figures,
                 int columns) {
  if (figures.empty()) return;
  const Box box = pages.begin(id, title);
  draw_grid(pages.page(), box, figures, columns);
}

}  // namespace

Document plan_document(const PlanReport& r, const Texts& t) {
  Document d{.title = t("cover.plan"), .subject = subject_of(r.facts), .created = r.facts.started};
  d.language = t.language();
  d.footer = t("footer.plan");
  d.source = fmt::format("{}: {} \xC2\xB7 Versine {} \xC2\xB7 {}", t("footer.source"), r.facts.folder, r.facts.version,
                         r.facts.started);
  Pages pages(d);
  add_cover(pages, r, t);
  add_figures(pages, "curves", t("plan.curves_title"), plan_sigma_figures(r, t), 2);
  add_figures(pages, "maps", t("plan.maps_title"), plan_map_figures(r, t), 2);
  add_figures(pages, "runs", t("plan.monte_carlo_title"), plan_histograms(r, t), 2);
  add_figures(pages, "compared", t("plan.methods_title"), plan_method_figures(r, t), 2);
  add_tables(pages, r, t);
  add_inputs(pages, r.facts, t);
  finish(d, t);
  return d;
}

}  // namespace versine::report
