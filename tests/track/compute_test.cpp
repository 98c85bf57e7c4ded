// SPDX-License-Identifier: Apache-2.0
#include "versine/track/compute.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "test_run.hpp"
#include "versine/core/numbers.hpp"
#include "versine/track/butterworth.hpp"

namespace versine::track {
namespace {

using test::Builder;
using test::Track;

GeometryOptions axis_options() {
  GeometryOptions o;
  o.height_reference = HeightReference::axis;
  return o;
}

Geometry compute(const Track& track, const test::Run& run, GeometryOptions options, bool with_design = true) {
  GeometryInput input;
  input.trajectory = &run.trajectory;
  input.gauge = run.gauge;
  input.trolley = run.trolley;
  input.design = with_design ? &track.design : nullptr;
  if (!with_design) input.projection = *geodesy::Projection::create("EPSG:25832");
  SilentProgress progress;
  auto g = compute_geometry(input, options, progress);
  EXPECT_TRUE(g) << (g ? "" : g.error().message());
  return g ? *g : Geometry{};
}

double worst(const Geometry& g, const char* name, const std::function<double(double)>& truth, double from, double to) {
  double w = 0;
  const Column& c = g.at(name);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (g.mileage[i] < from || g.mileage[i] > to) continue;
    EXPECT_TRUE(std::isfinite(c.value[i])) << name << " at " << g.mileage[i];
    w = std::max(w, std::abs(c.value[i] - truth(g.mileage[i])));
  }
  return w;
}

struct Case {
  double direction, travel;
};
class EitherWay : public ::testing::TestWithParam<Case> {};

TEST_P(EitherWay, RecoversAKnownTrackInMicrometres) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  track.lateral = [](double s) { return 0.004 * std::sin(two_pi * s / 30.0); };
  track.vertical = [](double s) { return 0.003 * std::sin(two_pi * s / 20.0); };
  track.gauge = [](double s) { return 1.435 + 0.002 * std::sin(two_pi * s / 25.0); };
  track.cross = [](double s) { return 0.002 * std::sin(two_pi * s / 15.0); };
  const auto run = Builder(track, projection).run(10.0, 1200.0, 0.05, GetParam().direction, GetParam().travel);
  const Geometry g = compute(track, run, axis_options());
  EXPECT_LT(worst(g, "cross_level_deviation", track.cross, 12, 1195), 75e-6);
  EXPECT_LT(worst(g, "gauge", track.gauge, 12, 1195), 20e-6);
  EXPECT_LT(worst(g, "deviation_lateral_axis", track.lateral, 12, 1195), 30e-6);
  EXPECT_LT(worst(g, "deviation_vertical_axis", track.vertical, 12, 1195), 60e-6);
  const auto left = [&](double s) { return track.lateral(s) - 0.5 * (track.gauge(s) - 1.435); };
  const auto right = [&](double s) { return track.lateral(s) + 0.5 * (track.gauge(s) - 1.435); };
  EXPECT_LT(worst(g, "deviation_lateral_left", left, 12, 1195), 75e-6);
  EXPECT_LT(worst(g, "deviation_lateral_right", right, 12, 1195), 75e-6);
  EXPECT_LT(worst(
                g, "curvature", [](double) { return 1.0 / 800.0; }, 530, 770),
            2e-4);  // the wave adds 1.5e-4
  EXPECT_LT(worst(
                g, "gradient", [](double) { return 0.008; }, 30, 390),
            6e-4);
  for (const Column& c : g.columns) EXPECT_EQ(c.value.size(), g.size()) << c.name;
}
INSTANTIATE_TEST_SUITE_P(Directions, EitherWay, ::testing::Values(Case{1, 1}, Case{1, -1}, Case{-1, -1}, Case{-1, 1}));

TEST(Geometry, ConstantCantArcIsHandComputed) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  const auto run = Builder(track, projection).run(450.0, 850.0, 0.05);
  GeometryOptions options = axis_options();
  options.chords = {{20.0, 10.0}, {10.0, 3.0}};
  const Geometry g = compute(track, run, options);
  const std::size_t i = g.index_at(650.0);
  EXPECT_NEAR(g.at("cross_level").value[i], 0.100, 15e-6);
  EXPECT_NEAR(g.at("twist_3m").value[i], 0.0, 1e-6);
  EXPECT_NEAR(g.at("twist_3m").value[g.index_at(480.0)], 0.001, 2e-6);  // 100 mm over 100 m
  EXPECT_NEAR(g.at("gauge").value[i], 1.435, 5e-6);
  // Rails are 0.7175 m cos(tilt) from the axis; mileage is on the axis and in map metres (scale near 0.99965).
  const double scale = projection.distortion(projection.inverse({560000, 5600000, 0})).scale;
  const double outer = 800.0 / scale + 0.716, inner = 800.0 / scale - 0.716;
  const auto versine = [&](double r) {
    const double half = 10.0 / scale * r / (800.0 / scale);  // arc from the middle to the end, real metres
    return r * (1 - std::cos(half / r));
  };
  EXPECT_NEAR(g.at("versine_lateral_left_20m").value[i], -versine(outer), 5e-6);
  EXPECT_NEAR(g.at("versine_lateral_right_20m").value[i], -versine(inner), 5e-6);
  EXPECT_NEAR(g.at("versine_lateral_left_10m_at_3m").value[i], -3.0 * 7.0 / 1600.0, 3e-5);
  EXPECT_NEAR(g.at("check_30m_lateral_left").value[i], 0.0, 1e-5);
  EXPECT_NEAR(g.at("curvature").value[i], 1.0 / 800.0, 3e-6);
}

TEST(Geometry, SineIrregularityThroughBandsChordsAndProjection) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  for (const bool with_design : {true, false}) {
    for (const double wavelength : {10.0, 20.0, 40.0}) {
      Track track;
      track.lateral = [=](double s) { return 0.005 * std::sin(two_pi * s / wavelength); };
      track.vertical = [=](double s) { return 0.005 * std::cos(two_pi * s / wavelength); };
      const auto run = Builder(track, projection).run(920.0, 1480.0, 0.05);
      const Geometry g = compute(track, run, axis_options(), with_design);
      const auto sections = band_pass(3, 25, 0.25, 4);
      const double gain = gain_both_ways(sections, wavelength, 0.25);
      double a = 0, b = 0, n = 0;
      for (std::size_t i = 0; i < g.size(); ++i) {
        const double s = g.mileage[i] + (with_design ? 0.0 : 920.0);
        if (s < 1120 || s >= 1280) continue;
        a += 2 * g.at("alignment_left_d1").value[i] * std::sin(two_pi * s / wavelength);
        b += 2 * g.at("level_right_d1").value[i] * std::cos(two_pi * s / wavelength);
        n += 1;
      }
      EXPECT_NEAR(a / n, 0.005 * gain, 5e-5) << wavelength << with_design;
      EXPECT_NEAR(b / n, 0.005 * gain, 5e-5) << wavelength << with_design;
    }
  }
}

TEST(Geometry, GaugeMissingForAPartIsFlaggedAndTheRestContinues) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  auto run = Builder(track, projection).run(10.0, 300.0, 0.05);
  std::erase_if(run.gauge.samples, [](const auto& g) { return g.time.seconds() > 200 && g.time.seconds() < 300; });
  const Geometry g = compute(track, run, axis_options());
  const std::size_t in = g.index_at(135.0), out = g.index_at(50.0);
  EXPECT_TRUE(g.flags[in] & no_gauge);
  EXPECT_TRUE(std::isnan(g.at("gauge").value[in]));
  EXPECT_TRUE(std::isnan(g.at("deviation_lateral_right").value[in]));
  EXPECT_TRUE(std::isfinite(g.at("deviation_lateral_left").value[in]));
  EXPECT_TRUE(std::isfinite(g.at("deviation_vertical_right").value[in]));
  EXPECT_NEAR(g.at("deviation_lateral_axis").value[in], 0.0, 1e-4);
  EXPECT_FALSE(g.flags[out] & no_gauge);
  EXPECT_THAT(g.record.warnings, ::testing::Contains(::testing::HasSubstr("without gauge")));
}

TEST(Geometry, RollingBackIsToldAndTheFirstPassIsUsed) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  auto run = Builder(track, projection).run(10.0, 100.0, 0.05);
  auto& s = run.trajectory.samples;
  std::vector<geodesy::TrajectoryPoint> again(s.begin(), s.begin() + 1201);
  for (int k = 1; k <= 100; ++k) again.push_back(s[1200 - k]);
  again.insert(again.end(), s.begin() + 1101, s.end());
  for (std::size_t k = 0; k < again.size(); ++k) again[k].time = Time{static_cast<std::int64_t>(k) * 100'000'000};
  s = again;
  run.gauge.samples.clear();
  const Geometry g = compute(track, run, axis_options());
  ASSERT_FALSE(g.record.findings.empty());
  EXPECT_EQ(g.record.findings[0].kind, "backwards");
  EXPECT_TRUE(g.flags[g.index_at(67.0)] & repeated);
  EXPECT_FALSE(g.flags[g.index_at(50.0)] & repeated);
  EXPECT_LT(worst(
                g, "deviation_lateral_left", [](double) { return 0.0; }, 12, 95),
            3e-5);
}

TEST(Geometry, BadInputIsAClearError) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  const auto run = Builder(track, projection).run(10.0, 100.0, 0.05);
  design::Alignment elsewhere = test::example_line();
  elsewhere.horizontal = *design::HorizontalAxis::chain({660000.0, 5600000.0, 0.7}, {design::line(400)});
  GeometryInput input;
  input.trajectory = &run.trajectory;
  input.design = &elsewhere;
  SilentProgress progress;
  auto g = compute_geometry(input, {}, progress);
  ASSERT_FALSE(g);
  EXPECT_THAT(g.error().message(), ::testing::HasSubstr("contains the run"));
  input.design = nullptr;
  input.marks = {{Time{0}, 1000.0}, {run.trajectory.back().time, 1200.0}};
  g = compute_geometry(input, {}, progress);
  ASSERT_FALSE(g);
  EXPECT_EQ(g.error().field, "marks");
  geodesy::Trajectory still;
  for (int i = 0; i < 100; ++i) {
    still.samples.push_back(run.trajectory[0]);
    still.samples.back().time = Time{i * 1000};
  }
  input.marks.clear();
  input.trajectory = &still;
  EXPECT_FALSE(compute_geometry(input, {}, progress));
  still.samples.resize(1);
  EXPECT_FALSE(compute_geometry(input, {}, progress));
}

TEST(Geometry, MarksStretchTheMileage) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  Track track;
  const auto run = Builder(track, projection).run(10.0, 110.0, 0.05);
  GeometryInput input;
  input.trajectory = &run.trajectory;
  input.marks = {{Time{0}, 5000.0}, {run.trajectory.back().time, 5100.5}};
  SilentProgress progress;
  const auto g = compute_geometry(input, {}, progress);
  ASSERT_TRUE(g) << g.error().message();
  EXPECT_NEAR(g->mileage.front(), 5000.0, 0.26);
  EXPECT_NEAR(g->mileage.back(), 5100.5, 0.26);
  EXPECT_EQ(g->find("gauge"), nullptr);
}

}  // namespace
}  // namespace versine::track
