// SPDX-License-Identifier: Apache-2.0
#include "versine/design/optimal_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "versine/core/numbers.hpp"

namespace versine::design {
namespace {

/// The line of the issue: two arcs, four transitions (clothoid and Bloss), a compound curve.
Alignment truth() {
  Alignment a;
  a.horizontal = *HorizontalAxis::chain(
      {500000.0, 5600000.0, 0.7},
      {line(310.0), transition(Shape::clothoid, 90.0, inf, 600.0), arc(280.0, 600.0),
       transition(Shape::clothoid, 60.0, 600.0, 900.0), arc(240.0, 900.0), transition(Shape::bloss, 110.0, 900.0, inf),
       line(260.0), transition(Shape::bloss, 120.0, inf, -700.0), arc(330.0, -700.0),
       transition(Shape::clothoid, 100.0, -700.0, inf), line(300.0)});
  std::vector<CantPoint> cant;
  for (const auto& e : a.horizontal.elements()) {
    cant.push_back({e.distance, 70.0 * e.element.curvature_start, e.element.shape});
  }
  a.cant = *CantProfile::from_points(cant);
  a.profile = *Profile::from_points({{0.0, 100.0},
                                     {700.0, 104.2, VerticalPoint::Curve::parabola, 90.0},
                                     {1500.0, 102.0, VerticalPoint::Curve::parabola, 70.0},
                                     {2200.0, 110.0}});
  return a;
}

/// A track on that line: irregularities as sums of sinusoids with wavelengths of 3 to 70 m (amplitude growing with
/// wavelength, `rms` metres in all), the heading with them, plus noise of the survey.
std::vector<TrackSample> survey(const Alignment& a, double rms, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi), where(std::log(3.0), std::log(70.0));
  std::normal_distribution<double> normal;
  struct Wave {
    double k, phase, amplitude;
  };
  const auto waves = [&] {
    std::vector<Wave> w(40);
    double sum = 0.0;
    for (Wave& x : w) {
      const double length = std::exp(where(random));
      x = {2.0 * std::numbers::pi / length, phase(random), length};
      sum += 0.5 * x.amplitude * x.amplitude;
    }
    for (Wave& x : w) x.amplitude *= rms / std::sqrt(sum);
    return w;
  };
  const std::vector<Wave> lateral = waves(), vertical = waves(), cross = waves();
  const auto value = [](const std::vector<Wave>& w, double s) {
    double y = 0.0;
    for (const Wave& x : w) y += x.amplitude * std::sin(x.k * s + x.phase);
    return y;
  };
  std::vector<TrackSample> out;
  for (double s = 0.0; s <= a.length(); s += 0.25) {
    const DesignPoint p = a.at(s);
    double slope = 0.0;
    for (const Wave& x : lateral) slope += x.amplitude * x.k * std::cos(x.k * s + x.phase);
    const double offset = value(lateral, s) + 2e-4 * normal(random);
    out.push_back({s * 1.0002, p.easting + offset * std::cos(p.heading), p.northing - offset * std::sin(p.heading),
                   p.heading + slope + 2e-5 * normal(random), p.height + value(vertical, s), p.cant + value(cross, s)});
  }
  return out;
}

TEST(OptimalAxis, RecoversRadiiWithinAThousandthAndJointsWithinAMetre) {
  const Alignment a = truth();
  const auto& elements = a.horizontal.elements();
  double worst_radius = 0.0, worst_joint = 0.0;
  const std::clock_t begin = std::clock();
  double joints = 0.0, curvatures = 0.0, cants = 0.0, gradients = 0.0, gradients_at = 0.0;
  int joint_count = 0, curvature_count = 0;
  constexpr unsigned runs = 6;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const auto fit = optimal_axis(survey(a, 1e-3, seed));
    ASSERT_TRUE(fit) << fit.error().message();
    const auto& found = fit->alignment.horizontal.elements();
    ASSERT_EQ(found.size(), elements.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].element.shape, elements[i].element.shape) << i;
      if (i > 0) {
        joints += std::pow((found[i].distance - elements[i].distance) / fit->sigma[i].joint, 2);
        ++joint_count;
      }
      worst_joint = std::max(worst_joint, std::abs(found[i].distance - elements[i].distance));
      if (elements[i].element.shape != Shape::arc) continue;
      curvatures += std::pow(
          (found[i].element.curvature_start - elements[i].element.curvature_start) / fit->sigma[i].curvature, 2);
      ++curvature_count;
      const double cant = fit->alignment.cant.at(found[i].distance + 0.5 * found[i].element.length).cant;
      cants += std::pow((cant - 70.0 * elements[i].element.curvature_start) / fit->sigma[i].cant, 2);
      worst_radius = std::max(worst_radius,
                              std::abs(elements[i].element.curvature_start / found[i].element.curvature_start - 1.0));
    }
    ASSERT_EQ(fit->gradient_sigma.size(), 3u);
    const auto& points = fit->alignment.profile.points();
    const double gradient[] = {4.2 / 700.0, -2.2 / 800.0, 8.0 / 700.0}, place[] = {0.0, 700.0, 1500.0};
    for (std::size_t k = 0; k < 3; ++k) {
      const double found_gradient =
          (points[k + 1].height - points[k].height) / (points[k + 1].distance - points[k].distance);
      gradients += std::pow((found_gradient - gradient[k]) / fit->gradient_sigma[k].gradient, 2) / 3.0;
      if (k > 0) gradients_at += std::pow((points[k].distance - place[k]) / fit->gradient_sigma[k].place, 2) / 2.0;
    }
    EXPECT_LT(fit->cant_rms, 1.5e-3);
    EXPECT_LT(fit->height_rms, 1.5e-3);
    for (double s = 50.0; s < a.length() - 50.0; s += 10.0) {
      EXPECT_NEAR(fit->alignment.at(s).cant, a.at(s).cant, 2e-3) << s;
      ASSERT_NEAR(fit->alignment.at(s).height, a.at(s).height, 2.5e-3) << s << " seed " << seed;
    }
  }
  std::printf(
      "optimal axis, %u runs: radii within %.4f %%, joints within %.3f m, %.2f s CPU each; errors over their "
      "sigma (RMS): joints %.2f, curvatures %.2f, cants %.2f, gradients %.2f, their places %.2f\n",
      runs, 100.0 * worst_radius, worst_joint, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / runs,
      std::sqrt(joints / joint_count), std::sqrt(curvatures / curvature_count), std::sqrt(cants / curvature_count),
      std::sqrt(gradients / runs), std::sqrt(gradients_at / runs));
  // 60 joints and 18 curvatures, correlated within a run, so that the bounds are wide; 1 is right. The cant of an arc
  // is a mean over 300 m; these irregularities end at 70 m, and a window of 400 m cannot tell them from longer ones.
  for (const double square : {joints / joint_count, curvatures / curvature_count, cants / curvature_count,
                              gradients / runs, gradients_at / runs}) {
    EXPECT_GT(square, 0.15);
    EXPECT_LT(square, 2.0);
  }
  EXPECT_LT(worst_radius, 1e-3);
  EXPECT_LT(worst_joint, 1.0);
}

TEST(OptimalAxis, ALineOfManyCurvesKeepsItsStructure) {
  std::mt19937 random(9);
  const auto between = [&random](double low, double high) {
    return low + static_cast<double>(random() % 1000) * (high - low) / 1000.0;
  };
  std::vector<HorizontalElement> elements = {line(200.0)};
  for (int i = 0; i < 6; ++i) {
    const double radius = (i % 3 == 1 ? -1.0 : 1.0) * between(350.0, 2800.0);
    elements.push_back(transition(Shape::clothoid, between(40.0, 140.0), inf, radius));
    elements.push_back(arc(between(100.0, 450.0), radius));
    elements.push_back(transition(Shape::clothoid, between(40.0, 140.0), radius, inf));
    elements.push_back(line(between(25.0, 500.0)));
  }
  Alignment a;
  a.horizontal = *HorizontalAxis::chain({0.0, 0.0, 0.0}, elements);
  a.profile = Profile::constant(0.0, 10.0, 0.004, a.length());
  a.cant = *CantProfile::from_points({{0.0, 0.0}});
  const auto fit = optimal_axis(survey(a, 1e-3, 5));
  ASSERT_TRUE(fit) << fit.error().message();
  const auto& found = fit->alignment.horizontal.elements();
  ASSERT_EQ(found.size(), elements.size());
  EXPECT_LT(fit->offset_rms, 1.3e-3);
  for (std::size_t i = 2; i < found.size(); i += 4) {
    EXPECT_NEAR(elements[i].curvature_start / found[i].element.curvature_start, 1.0, 2e-3) << i;
  }
}

TEST(OptimalAxis, AStraightIsOneLineAndBadInputIsNamed) {
  Alignment a;
  a.horizontal = *HorizontalAxis::chain({0.0, 0.0, 1.0}, {line(500.0)});
  a.profile = Profile::constant(0.0, 10.0, 0.004, 500.0);
  a.cant = *CantProfile::from_points({{0.0, 0.0}});
  auto samples = survey(a, 1e-3, 5);
  const auto fit = optimal_axis(samples);
  ASSERT_TRUE(fit) << fit.error().message();
  ASSERT_EQ(fit->alignment.horizontal.elements().size(), 1u);
  EXPECT_EQ(fit->alignment.horizontal.elements()[0].element.shape, Shape::line);
  EXPECT_FALSE(optimal_axis(std::span(samples).first(10)));
  samples[700].easting = std::nan("");
  const auto bad = optimal_axis(samples);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().line, 701u);
}

TEST(OptimalAxis, RoundedRadiiAndLengthsAreFittedAgain) {
  const auto fit = optimal_axis(survey(truth(), 1e-3, 2), {.round_radius = 5.0, .round_length = 1.0});
  ASSERT_TRUE(fit) << fit.error().message();
  for (const auto& e : fit->alignment.horizontal.elements()) {
    if (e.element.shape == Shape::arc) {
      const double r = 1.0 / e.element.curvature_start;
      EXPECT_NEAR(r, 5.0 * std::round(r / 5.0), 1e-9);
    }
  }
  EXPECT_LT(fit->offset_rms, 1.5e-3);
}

}  // namespace
}  // namespace versine::design
