// SPDX-License-Identifier: Apache-2.0
#include "versine/report/drawing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>
#include <regex>
#include <sstream>

#include "versine/report/pdf.hpp"
#include "versine/report/strip.hpp"
#include "versine/report/svg.hpp"

namespace versine::report {
namespace {

using ::testing::HasSubstr;

TEST(Drawing, LinesOfTextFitTheirWidth) {
  const std::string text =
      "Each stretch over a limit with its peak, by place, and averyveryverylongwordindeed at the end";
  std::string again;
  for (const std::string& line : wrapped(text, 30.0, 2.5)) {
    EXPECT_LE(text_width(line, 2.5), 30.0 + 1e-9) << line;
    again += (again.empty() ? "" : " ") + line;
  }
  EXPECT_THAT(again, HasSubstr("Each stretch over a limit"));
  for (const std::string& line : wrapped("右侧指里程增加方向的右侧", 10.0, 2.5)) EXPECT_LE(text_width(line, 2.5), 10.0);
  EXPECT_EQ(fitted("short", 50.0, 2.5), "short");
  EXPECT_LE(text_width(fitted(text, 20.0, 2.5), 2.5), 20.5);
}

TEST(Svg, IsWellFormedWhateverTheTextsAre) {
  Drawing d;
  d.begin(Group{"row", "a < b & \"c\"", "id"});
  d.text({1, 2}, "1 < 2 & 3 > 2 \x01 σ");
  d.end();
  d.begin(Clip{{0, 0, 10, 10}});
  d.polyline({{0, 0}, {1, 1}, pen_up, {2, 2}, {3, 3.5}}, {});
  d.area({{0, 0}, {1, 0}, {1, 1}}, {0xff0000, 0.5});
  d.circle({5, 5}, 1, Fill{0xffffff});
  d.begin(Group{"img", "left open", ""});
  const std::string svg = to_svg(d, true);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str())) << svg;
  EXPECT_THAT(svg, HasSubstr("M0 0l20 20M40 40l20 30"));  // twentieths of a millimetre; the NaN lifts the pen
  EXPECT_THAT(svg, ::testing::Not(HasSubstr("nan")));
  EXPECT_STREQ(document.select_node("//text[@role='cell']").node().text().get(), "1 < 2 & 3 > 2   σ");
}

TEST(Strip, ASingleExtremeSampleIsSeenAfterThinning) {
  std::vector<double> x, y;
  for (int i = 0; i < 40'000; ++i) {
    x.push_back(0.25 * i);
    y.push_back(std::sin(0.01 * i));
  }
  y[20'000] = 9.0;
  y[30'001] = -7.0;
  for (int i = 25'000; i < 25'400; ++i) y[static_cast<std::size_t>(i)] = std::nan("");
  Strip s{.name = "gauge", .detail = "mm"};
  s.curves.push_back({y, {}});
  fit_scale(s);
  EXPECT_LT(s.low, -7.0);
  EXPECT_GT(s.high, 9.0);
  StripAxis axis{.x = x, .from = 0.0, .to = x.back(), .span = x.back()};
  axis.posted = [](double v) { return v; };
  axis.label = [](double v) { return std::to_string(v); };
  Drawing d;
  draw_strips(d, {0, 0, 281, 100}, std::span(&s, 1), axis);
  const Path* curve = nullptr;
  for (const Item& item : d.items) {
    const auto* p = std::get_if<Path>(&item);
    if (p != nullptr && (curve == nullptr || p->points.size() > curve->points.size())) curve = p;
  }
  ASSERT_NE(curve, nullptr);
  EXPECT_LT(curve->points.size(), 2u * static_cast<std::size_t>(281.0 / 0.35));
  double top = 1e9, bottom = -1e9;
  int gaps = 0;
  for (const Point& p : curve->points) {
    gaps += std::isnan(p.x) ? 1 : 0;
    if (std::isnan(p.x)) continue;
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  EXPECT_EQ(gaps, 1);
  // The scale's own room is 8 % above and 12 % below.
  EXPECT_NEAR((bottom - top) / (100.0 - 5.5 - 1.6), 1.0 / 1.2, 0.01);
  const std::string svg = to_svg(d);
  EXPECT_THAT(svg, HasSubstr("max 9.0"));
  EXPECT_THAT(svg, HasSubstr("min -7.0"));
}

/// Height of the tallest filled area of a rough curve with this sigma, mm of paper; 0: none.
double band_height(double sigma) {
  std::vector<double> x, y;
  for (int i = 0; i < 500; ++i) {
    x.push_back(1.0 * i);
    y.push_back(i % 2 == 0 ? 1.0 : -1.0);
  }
  const std::vector<double> sigmas(y.size(), sigma);
  Strip s{.name = "gauge", .detail = "mm"};
  s.curves.push_back({y, sigmas});
  s.low = -10.0, s.high = 10.0;
  StripAxis axis{.x = x, .from = 0.0, .to = x.back(), .span = x.back()};
  axis.posted = [](double v) { return v; };
  axis.label = [](double v) { return std::to_string(v); };
  Drawing d;
  draw_strips(d, {0, 0, 559, 100}, std::span(&s, 1), axis);
  double tallest = 0.0;
  for (const Item& item : d.items) {
    const auto* p = std::get_if<Path>(&item);
    if (p == nullptr || !p->fill || p->points.size() < 100) continue;
    // Upper edge forward, lower edge backward: the same place stands as far from both ends.
    for (std::size_t i = 0; i < p->points.size() / 2; ++i) {
      tallest = std::max(tallest, p->points[p->points.size() - 1 - i].y - p->points[i].y);
    }
  }
  return tallest;
}

TEST(Strip, BandIsTheUncertaintyAndNotTheRangeOfTheCurve) {
  const double per_mm = (100.0 - 5.5 - 1.6) / 20.0;
  EXPECT_NEAR(band_height(1.0), 2 * 1.96 * per_mm, 0.02);  // one value a millimetre of paper
  EXPECT_EQ(band_height(0.005), 0.0);                      // thinner than the curve
}

TEST(Strip, NumbersHaveNoNegativeZero) {
  EXPECT_EQ(decimal(-0.04, 1), "0.0");
  EXPECT_EQ(decimal(-0.06, 1), "-0.1");
  EXPECT_EQ(decimal(std::nan(""), 1), "");
}

class Pdf : public ::testing::Test {
 protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      (std::string("versine-report-pdf-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
};

TEST_F(Pdf, HasItsPagesAndText) {
  Drawing a, b;
  a.text({10, 10}, "Gauge 1435 mm σ 0.1");
  a.text({10, 20}, "轨道几何测量");
  b.polyline({{0, 0}, {100, 100}}, {});
  const auto path = folder_ / "a.pdf";
  ASSERT_TRUE(write_pdf(path, {{&a, "First"}, {&b, ""}}, {.title = "T", .created = "2026-11-23T12:00:00Z"}));
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  const std::string pdf = bytes.str();
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  const std::regex page("/Type /Page[^s]");
  EXPECT_EQ(std::distance(std::sregex_iterator(pdf.begin(), pdf.end(), page), {}), 2);
  EXPECT_THAT(pdf, HasSubstr("/ToUnicode"));  // what makes text searchable
  if (std::system("pdftotext -v >/dev/null 2>&1") != 0) GTEST_SKIP() << "no pdftotext (poppler-utils)";
  const auto text = folder_ / "a.txt";
  ASSERT_EQ(std::system(("pdftotext " + path.string() + " " + text.string()).c_str()), 0);
  std::ifstream out(text);
  std::ostringstream words;
  words << out.rdbuf();
  EXPECT_THAT(words.str(), HasSubstr("Gauge 1435 mm"));
  EXPECT_THAT(words.str(), HasSubstr("轨道几何测量"));
}

TEST_F(Pdf, AnUnwritablePlaceIsTold) {
  Drawing a;
  const auto done = write_pdf(folder_ / "missing" / "a.pdf", {{&a, ""}}, {});
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message(), HasSubstr("a.pdf"));
}

}  // namespace
}  // namespace versine::report
