// SPDX-License-Identifier: Apache-2.0
#include "versine/report/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>

namespace versine::report {
namespace {

TEST(Figure, TicksAreRoundAndInside) {
  EXPECT_THAT(ticks(0, 60, 6), ::testing::ElementsAre(0, 10, 20, 30, 40, 50, 60));
  EXPECT_THAT(ticks(0.13, 0.61, 5), ::testing::ElementsAre(::testing::DoubleEq(0.2), ::testing::DoubleNear(0.3, 1e-12),
                                                           ::testing::DoubleEq(0.4), ::testing::DoubleEq(0.5),
                                                           ::testing::DoubleNear(0.6, 1e-12)));
  EXPECT_THAT(ticks(2, 2, 5), ::testing::ElementsAre(2));
}

TEST(Figure, ContourOfACircle) {
  Field f;
  for (int i = 0; i <= 40; ++i) {
    f.x.push_back(-2 + 0.1 * i);
    f.y.push_back(-2 + 0.1 * i);
  }
  for (const double y : f.y) {
    for (const double x : f.x) f.value.push_back(x * x + y * y);
  }
  double length = 0.0;
  for (const Segment& s : contour(f, 1.0)) {
    EXPECT_NEAR(std::hypot(s.x1, s.y1), 1.0, 0.003);
    length += std::hypot(s.x2 - s.x1, s.y2 - s.y1);
  }
  EXPECT_NEAR(length, 2 * std::acos(-1.0), 0.03);
}

TEST(Figure, SvgIsWellFormedWhateverIsDrawn) {
  Figure f{.title = "a < b & \"c\"", .x = {.label = "x, m"}, .y = {.label = "y, mm"}};
  f.curves.push_back({"one", {0, 1, 2, 3}, {1, std::nan(""), 3, 2}});
  f.curves.push_back({"two", {0, 1, 2, 3}, {1, 2, 3, 2}, CurveStyle::points});
  f.curves.push_back({"", {0, 1, 2, 3}, {1, 2, 3, 2}, CurveStyle::bars});
  Figure map{.title = "map"};
  map.field =
      Field{.x = {0, 1, 2}, .y = {0, 1}, .value = {0, 1, 2, 1, 2, 3}, .contours = {0.5}, .emphasis = 1.5, .label = "r"};
  Figure logarithmic{.title = "log", .x = {.logarithmic = true}, .y = {.logarithmic = true}};
  logarithmic.curves.push_back({"l", {1, 10, 100}, {0.0, 1, 2}, CurveStyle::dashed});
  const Figure all[] = {f, map, logarithmic, Figure{.title = "empty"}};
  for (const std::string& svg : {to_svg(f), to_svg(all, 2)}) {
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(svg.c_str())) << svg.substr(0, 300);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

}  // namespace
}  // namespace versine::report
