// SPDX-License-Identifier: Apache-2.0
#include "versine/report/survey_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <pugixml.hpp>

namespace versine::report {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// 1.2 km with a chainage jump at 600 m, a stretch without values, one exceedance.
SurveyReport sample() {
  SurveyReport r;
  r.facts.title = "Line 1 <test> & more";
  r.facts.folder = "demo.result";
  r.facts.version = "0.1.0";
  r.facts.warnings = {"sleepers: 12 found"};
  r.conventions = {{"lateral", "positive to the right in the direction of increasing mileage"}};
  r.crs = "EPSG:25832";
  r.height_datum = "ellipsoidal";
  r.origin = "aided INS, smoothed";
  Quantity gauge{"gauge_deviation", "mm", {}, {}}, bend{"curvature", "1/km", {}, {}};
  for (int i = 0; i <= 4800; ++i) {
    const double s = 100.0 + 0.25 * i;
    r.distance.push_back(s);
    r.posted.push_back(s < 600.0 ? 18000.0 + s : 18000.0 + s - 15.0);
    r.axis.push_back({500000.0 + s, 5600000.0});
    gauge.value.push_back(s > 300.0 && s < 350.0 ? std::nan("")
                                                 : std::sin(0.1 * s) + (std::abs(s - 700.0) < 2.0 ? 9 : 0));
    gauge.sigma.push_back(0.1);
    bend.value.push_back(1.0);
  }
  r.quantities = {gauge, bend};
  r.limits = "profile";
  r.limits_source = "somewhere";
  r.speed_kmh = 120;
  r.levels = {"AL", "IL", "IAL"};
  r.applied = {{"gauge_deviation", "AL", 0, -5, 5}, {"gauge_deviation", "IL", 1, -8, 8}};
  r.exceedances = {
      {"start_m", "end_m", "peak_m", "length_m", "column", "unit", "level", "value", "sigma", "limit",
       "probability_over", "easting_m", "northing_m", "start_distance_m", "end_distance_m", "peak_distance_m"},
      {{"18683.25", "18686.75", "18685.00", "3.50", "gauge_deviation", "mm", "IL", "9.774", "0.100", "8.000", "0.9859",
        "500700.000", "5600000.000", "698.25", "701.75", "700.00"}}};
  r.sections = {{"start_m", "end_m", "tqi_mm", "cosd_mm", "sigma_gauge_mm", "classes", "over", "start_distance_m",
                 "end_distance_m"},
                {{"18100.00", "18199.75", "", "", "0.707", "", "", "100.00", "199.75"},
                 {"18200.00", "18399.75", "", "", "0.711", "", "", "200.00", "399.75"}}};
  r.elements = {{"part", "start_distance_m", "start_m", "end_m", "length_m", "shape", "radius_start_m", "radius_end_m",
                 "cant_start_mm", "cant_end_mm", "easting_m", "northing_m", "height_m"},
                {{"horizontal", "0.000", "18000.000", "18600.000", "600.000", "arc", "1000.000", "1000.000", "80.00",
                  "80.00", "500000.0000", "5600000.0000", "100.0000"}}};
  return r;
}

std::vector<std::string> cells(const pugi::xml_document& html, const char* section) {
  std::vector<std::string> out;
  const std::string query = std::string("//section[@id='") + section + "']//text[@role='cell']";
  for (const auto& node : html.select_nodes(query.c_str())) out.emplace_back(node.node().text().get());
  return out;
}

TEST(SurveyReport, EveryLanguageIsWellFormedAndStatesSignsOnEachPage) {
  for (const std::string& language : languages()) {
    const Texts texts = Texts::load(language).value();
    const Document d = survey_document(sample(), texts);
    const std::string html = to_html(d, texts);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(html.c_str())) << language;
    std::size_t pages = 0;
    for (const auto& sheet : document.select_nodes("//div[@class='sheet']")) {
      std::string words;
      for (const auto& t : sheet.node().select_nodes(".//text")) words += std::string(t.node().text().get()) + "\n";
      // The foot is cut when it is too long for the page: its beginning must be there.
      EXPECT_THAT(words, HasSubstr(texts("footer.survey").substr(0, 60))) << language;
      EXPECT_THAT(words, HasSubstr("demo.result"));
      ++pages;
    }
    std::size_t drawn = 0;
    for (const Section& s : d.sections) drawn += s.pages.size();
    EXPECT_EQ(pages, drawn);
    EXPECT_GT(pages, 9u);
    EXPECT_EQ(html.find("nan "), std::string::npos) << language;
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("href=\"http"), std::string::npos);
  }
}

TEST(SurveyReport, FootIsNeverCut) {
  for (const std::string& language : languages()) {
    const Texts texts = Texts::load(language).value();
    for (const char* key : {"footer.survey", "footer.trajectory", "footer.georef", "footer.plan"}) {
      EXPECT_LE(text_width(texts(key), 2.15), Drawing{}.width) << language << " " << key;
    }
  }
}

TEST(SurveyReport, NumbersAreThoseOfTheFiles) {
  const Texts texts;
  pugi::xml_document html;
  ASSERT_TRUE(html.load_string(to_html(survey_document(sample(), texts), texts).c_str()));
  const auto exceedances = cells(html, "exceedances");
  for (const char* value : {"IL", "Gauge, minus nominal", "18+685.00", "18+683.25", "18+686.75", "3.50", "9.774",
                            "0.100", "8.000", "98.6", "500700.000", "5600000.000"}) {
    EXPECT_THAT(exceedances, Contains(value));
  }
  const auto sections = cells(html, "sections");
  EXPECT_THAT(sections, Contains("0.707"));
  EXPECT_THAT(sections, Contains("0.711"));
  const auto curves = cells(html, "curves");
  EXPECT_THAT(curves, Contains("1000.000"));
  EXPECT_THAT(curves, Contains("1000.00"));  // measured: mean curvature of 1/km
  EXPECT_THAT(curves, Contains("right"));
}

TEST(SurveyReport, StripsShowGapsAndChainageJumps) {
  const Texts texts;
  const Document d = survey_document(sample(), texts);
  const auto strips =
      std::find_if(d.sections.begin(), d.sections.end(), [](const Section& s) { return s.id == "strips"; });
  ASSERT_NE(strips, d.sections.end());
  EXPECT_EQ(strips->pages.size(), 3u);  // 100 to 1300 m, 500 m a page
  int gaps = 0;
  for (const Item& item : strips->pages[0].items) {
    if (const auto* p = std::get_if<Path>(&item); p != nullptr && p->points.size() > 100) {
      for (const Point& q : p->points) gaps += std::isnan(q.x) ? 1 : 0;
    }
  }
  EXPECT_EQ(gaps, 1);
  bool jump = false;
  for (const Item& item : strips->pages[1].items) {
    if (const auto* t = std::get_if<TextItem>(&item)) jump |= t->text == "18+600.00 = 18+585.00, -15.00 m";
  }
  EXPECT_TRUE(jump);
}

TEST(SurveyReport, VerdictFollowsTheSeverestLevel) {
  SurveyReport r = sample();
  EXPECT_EQ(verdict(r), Verdict::with_remarks);
  r.exceedances.rows[0][6] = "IAL";
  EXPECT_EQ(verdict(r), Verdict::not_accepted);
  r.exceedances.rows.clear();
  EXPECT_EQ(verdict(r), Verdict::accepted);
  r.levels.clear();
  EXPECT_EQ(verdict(r), Verdict::not_assessed);
}

TEST(SurveyReport, WithoutGeometryAndWithoutAnything) {
  const Texts texts;
  SurveyReport r;
  r.facts.title = "positions only";
  pugi::xml_document html;
  ASSERT_TRUE(html.load_string(to_html(survey_document(r, texts), texts).c_str()));
  r.time = {0.0, 1.0, 2.0};
  r.axis = {{0, 0}, {10, 0}, {20, 5}};
  r.trajectory = {{"speed", "m/s", {1, std::nan(""), 3}, {}}, {"height", "m", {5, 5, 5}, {0.1, 0.1, 0.1}}};
  const std::string text = to_html(survey_document(r, texts), texts);
  ASSERT_TRUE(html.load_string(text.c_str()));
  EXPECT_THAT(text, HasSubstr("NOT ASSESSED"));
  EXPECT_EQ(text.find("nan "), std::string::npos);
}

TEST(SurveyReport, WorkbookAndPdfAreWritten) {
  const auto folder = std::filesystem::temp_directory_path() / "versine_survey_report_test";
  std::filesystem::create_directories(folder);
  const Document d = survey_document(sample(), Texts());
  ASSERT_TRUE(write_document_xlsx(folder / "r.xlsx", d));
  ASSERT_TRUE(write_document_pdf(folder / "r.pdf", d));
  EXPECT_GT(std::filesystem::file_size(folder / "r.xlsx"), 5000u);
  EXPECT_GT(std::filesystem::file_size(folder / "r.pdf"), 20000u);
  EXPECT_FALSE(write_document_xlsx(folder / "missing" / "r.xlsx", d));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace versine::report
