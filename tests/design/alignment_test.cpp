// SPDX-License-Identifier: Apache-2.0
#include "versine/design/alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/design/assemble.hpp"

namespace versine::design {
namespace {

TEST(Transition, IntegralAndRateBelongToTheRamp) {
  for (int k = static_cast<int>(Shape::clothoid); k <= static_cast<int>(Shape::cubic_parabola); ++k) {
    const auto shape = static_cast<Shape>(k);
    EXPECT_NEAR(ramp(shape, 0.0), 0.0, 1e-15);
    EXPECT_NEAR(ramp(shape, 1.0), 1.0, 1e-14);
    EXPECT_NEAR(ramp_integral(shape, 1.0), 0.5, 1e-14);  // all are symmetric about the middle
    for (double xi = 0.03; xi < 0.98; xi += 0.05) {
      const double h = 1e-5;
      EXPECT_NEAR((ramp(shape, xi + h) - ramp(shape, xi - h)) / (2 * h), ramp_rate(shape, xi), 1e-6);
      EXPECT_NEAR((ramp_integral(shape, xi + h) - ramp_integral(shape, xi - h)) / (2 * h), ramp(shape, xi), 1e-6);
    }
  }
}

TEST(HorizontalAxis, HeadingAndCurvatureAreDerivativesOfThePosition) {
  for (int k = static_cast<int>(Shape::arc); k <= static_cast<int>(Shape::cubic_parabola); ++k) {
    HorizontalElement e = k == 1 ? arc(120.0, -300.0) : transition(static_cast<Shape>(k), 120.0, 1200.0, -300.0);
    if (e.shape == Shape::viennese) e.cant_term = -0.2;
    const auto axis = *HorizontalAxis::chain({10.0, 20.0, 2.0}, {e});
    for (double s = 1.0; s < 119.0; s += 3.3) {
      const double h = 1e-3;
      const AxisPose a = axis.at(s - h), p = axis.at(s), b = axis.at(s + h);
      EXPECT_NEAR(std::hypot(b.easting - a.easting, b.northing - a.northing) / (2 * h), 1.0, 1e-8);
      EXPECT_NEAR(std::atan2(b.easting - a.easting, b.northing - a.northing),
                  std::remainder(p.heading, 2 * std::numbers::pi), 1e-8);
      EXPECT_NEAR((b.heading - a.heading) / (2 * h), p.curvature, 1e-8) << to_string(e.shape);
      EXPECT_NEAR((b.curvature - a.curvature) / (2 * h), p.curvature_rate, 2e-9) << to_string(e.shape) << s;
    }
  }
}

TEST(HorizontalAxis, SineHalfWaveOfLandXmlIsTheCosineTransition) {
  // X = L - 0.0226689 L^3 / R^2, the coefficient being (2 pi^2 - 9) / (48 pi^2).
  const double l = 80.0, r = 2000.0, pi = std::numbers::pi;
  const AxisPose end = pose_on(transition(Shape::cosine, l, inf, r), {}, l);
  EXPECT_NEAR(end.northing, l - (2 * pi * pi - 9) / (48 * pi * pi) * l * l * l / (r * r), 1e-6);
}

TEST(HorizontalAxis, CubicParabolaIsItsFormula) {
  const double l = 90.0, r = 400.0;
  const auto e = transition(Shape::cubic_parabola, l, inf, r);
  for (double s = 5.0; s <= 90.0; s += 5.0) {
    const AxisPose p = pose_on(e, {}, s);
    EXPECT_NEAR(p.easting, std::pow(p.northing, 3) / (6.0 * r * l), 1e-12);
  }
}

TEST(HorizontalAxis, ElementsWithoutLengthOrNumberAreNamed) {
  for (const auto& bad : {line(0.0), line(-1.0), line(std::nan("")), arc(10.0, std::nan(""))}) {
    const auto axis = HorizontalAxis::chain({}, {line(10.0), bad});
    ASSERT_FALSE(axis);
    EXPECT_NE(axis.error().message().find("element 2"), std::string::npos);
  }
  EXPECT_FALSE(HorizontalAxis::chain({}, {}));
}

TEST(Profile, ParabolaAndCircleAgainstHandComputedValues) {
  // +1 % to -1 %, parabola of 100 m about 500 m at height 50: its top is 0.25 m under the intersection.
  const auto p = Profile::from_points({{0, 45}, {500, 50, VerticalPoint::Curve::parabola, 100.0}, {1000, 45}});
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->at(500.0).height, 49.75, 1e-12);
  EXPECT_NEAR(p->at(475.0).height, 49.5 + 0.01 * 25 - 0.0002 * 25 * 25 / 2, 1e-12);
  EXPECT_NEAR(p->at(475.0).gradient, 0.005, 1e-12);
  EXPECT_NEAR(p->at(500.0).curvature, -0.0002, 1e-12);
  // A circle of 5000 m: the same by the circle's equation about its centre.
  const auto c = Profile::from_points({{0, 45}, {500, 50, VerticalPoint::Curve::circle, 0.0, 5000.0}, {1000, 45}});
  ASSERT_TRUE(c);
  const double centre = 50.0 - 5000.0 / std::cos(std::atan(0.01));
  for (double s = 451.0; s < 550.0; s += 7.0) {
    EXPECT_NEAR(c->at(s).height, centre + std::sqrt(5000.0 * 5000.0 - (s - 500) * (s - 500)), 1e-9);
    const double h = 1e-3;
    EXPECT_NEAR(c->at(s).gradient, (c->at(s + h).height - c->at(s - h).height) / (2 * h), 1e-8);
  }
  EXPECT_NEAR(c->at(-10.0).height, 44.9, 1e-12);
  EXPECT_TRUE(std::isnan(Profile().at(3.0).height));
}

TEST(Profile, OverlappingCurvesAndBackwardDistancesAreRefusedByName) {
  using C = VerticalPoint::Curve;
  const auto overlap =
      Profile::from_points({{0, 0}, {100, 1, C::parabola, 120.0}, {150, 0, C::parabola, 60.0}, {300, 3}});
  ASSERT_FALSE(overlap);
  EXPECT_NE(overlap.error().field.find("point"), std::string::npos);
  EXPECT_FALSE(Profile::from_points({{0, 0}, {100, 1}, {90, 2}}));
  EXPECT_FALSE(Profile::from_points({{0, 0}}));
}

TEST(Cant, RampsAndSteps) {
  const auto c = CantProfile::from_points({{100, 0, Shape::bloss}, {200, 0.1}, {300, 0.1}, {300, 0.05}});
  ASSERT_TRUE(c);
  EXPECT_EQ(c->at(0.0).cant, 0.0);
  EXPECT_NEAR(c->at(150.0).cant, 0.05, 1e-15);
  EXPECT_NEAR(c->at(150.0).rate, 1.5 * 0.1 / 100.0, 1e-15);
  EXPECT_NEAR(c->at(125.0).cant, 0.1 * 0.0625 * 2.5, 1e-15);
  EXPECT_EQ(c->at(299.9).cant, 0.1);
  EXPECT_EQ(c->at(300.0).cant, 0.05);
}

TEST(Chainage, JumpsLeaveNumbersOutOrRepeatThem) {
  const auto c = Chainage::from_equations({{0, 1000}, {500, 1600}, {900, 1950}});
  ASSERT_TRUE(c);
  EXPECT_EQ(c->mileage(499.0), 1499.0);
  EXPECT_EQ(c->mileage(500.0), 1600.0);
  EXPECT_NEAR(c->jump(1), 100.0, 1e-12);
  EXPECT_NEAR(c->jump(2), -50.0, 1e-12);
  EXPECT_TRUE(c->distances(1550.0, 1200.0).empty());
  EXPECT_EQ(c->distances(1970.0, 1200.0), (std::vector<double>{870.0, 920.0}));
  EXPECT_EQ(*c->distance(1970.0, 1200.0, 1000.0), 920.0);
  const auto none = c->distance(1550.0, 1200.0);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("1+550.000"), std::string::npos);
  EXPECT_EQ(format_mileage(12345.6784), "12+345.678");
  EXPECT_EQ(format_mileage(999.9999), "1+000.000");
  EXPECT_EQ(format_mileage(-3.5), "-0+003.500");
  const auto down = Chainage::from_equations({{0, 5000, false}});
  EXPECT_EQ(down->mileage(100.0), 4900.0);
  EXPECT_EQ(*down->distance(4900.0, 200.0), 100.0);
}

RawElement raw(const HorizontalElement& e, const MapPose& start, const char* where) {
  const AxisPose end = pose_on(e, start, e.length);
  return {e, {start.easting, start.northing}, MapPosition{end.easting, end.northing}, where};
}

TEST(Assemble, AuditFindsKinksCurvatureJumpsAndCantAgainstCurvature) {
  RawAlignment r;
  r.name = "a";
  r.elements.push_back(raw(line(200.0), {0, 0, 0}, "first"));
  r.elements.push_back(raw(arc(200.0, 500.0), {0, 200, 5e-4}, "second"));
  r.cant = {{0, 0}, {200, 0}, {210, -0.05}, {400, -0.05}};
  const Imported noted = assemble(r);
  ASSERT_TRUE(noted.alignment) << noted.alignment.error().message();
  const auto has = [](const Audit& audit, const std::string& kind) {
    return std::any_of(audit.begin(), audit.end(), [&](const AuditFinding& f) { return f.kind == kind; });
  };
  for (const char* kind : {"kink", "curvature jump", "cant against curvature", "cant ramp without transition"}) {
    EXPECT_TRUE(has(noted.audit, kind)) << kind;
  }
  r.elements[1] = raw(arc(200.0, 500.0), {0, 200, 0.05}, "second");
  const Imported kinked = assemble(r);
  ASSERT_FALSE(kinked.alignment);
  EXPECT_TRUE(refused(kinked.audit));
  EXPECT_NE(kinked.alignment.error().message().find("second"), std::string::npos);
  r.elements[1].kink_intended = true;
  EXPECT_TRUE(assemble(r).alignment);
  r.cant[2].cant = 50.0;  // millimetres taken for metres
  EXPECT_FALSE(assemble(r).alignment);
  r.elements[0].element.length = 205.0;  // does not fit its points
  const Imported longer = assemble(r);
  ASSERT_FALSE(longer.alignment);
  EXPECT_NE(longer.alignment.error().message().find("first"), std::string::npos);
  EXPECT_FALSE(assemble(RawAlignment{}).alignment);
}

}  // namespace
}  // namespace versine::design
