// SPDX-License-Identifier: Apache-2.0
#include "versine/track/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::track {
namespace {

Geometry grid(std::size_t n) {
  Geometry g;
  for (std::size_t i = 0; i < n; ++i) {
    g.mileage.push_back(0.25 * double(i));
    g.time.push_back({});
    g.flags.push_back(0);
  }
  return g;
}

LimitProfile profile() {
  LimitProfile p;
  p.name = "test";
  p.levels = {"AL", "IL", "IAL"};
  SpeedClass s;
  s.speed = 50.0;
  s.limits = {{"alignment_*_d1", "AL", -0.006, 0.006, ""},
              {"alignment_*_d1", "IL", -0.008, 0.008, ""},
              {"alignment_*_d1", "IAL", -0.014, 0.014, ""},
              {"nothing", "AL", -1, 1, ""}};
  s.section_limits = {{"alignment_*_d1", "AL", 0.001, ""}};
  s.classes = {{"alignment_*_d1", {"A", "B", "C"}, {0.0005, 0.002}, ""}};
  s.tqi = 0.002;
  p.speeds = {s};
  p.tqi_columns = {"alignment_left_d1", "gauge"};
  return p;
}

TEST(Quality, ExceedancesAreMergedAroundTheirPeak) {
  Geometry g = grid(2000);
  Column& c = g.add("alignment_left_d1", "mm", 1e-3, "");
  const auto bump = [&](double at, double height, double width) {
    for (std::size_t i = 0; i < g.size(); ++i) {
      const double d = (g.mileage[i] - at) / width;
      if (std::abs(d) < 1) c.value[i] += height * (1 - d * d);
    }
  };
  for (double& v : c.value) v = 0;
  for (float& v : c.sigma) v = 0.0005f;
  bump(100, 0.0090, 4);   // IL
  bump(107, 0.0070, 2);   // AL, its own
  bump(200, -0.0150, 3);  // IAL, negative
  bump(300, 0.0055, 3);   // none
  const auto q = *assess(g, profile(), 40.0);
  ASSERT_EQ(q.exceedances.size(), 3u);
  EXPECT_EQ(q.exceedances[0].level, "IL");
  EXPECT_DOUBLE_EQ(q.exceedances[0].peak, 100.0);
  EXPECT_NEAR(q.exceedances[0].end - q.exceedances[0].start, 2 * 4 * std::sqrt(1 - 0.006 / 0.009), 0.5);
  EXPECT_NEAR(q.exceedances[0].probability, 0.97725, 1e-4);  // two sigma over 8 mm
  EXPECT_EQ(q.exceedances[1].level, "AL");
  EXPECT_EQ(q.exceedances[2].level, "IAL");
  EXPECT_DOUBLE_EQ(q.exceedances[2].limit, -0.014);
  EXPECT_EQ(q.unchecked, std::vector<std::string>{"nothing"});
  EXPECT_FALSE(assess(g, profile(), 60.0));
}

TEST(Quality, SectionsHaveSigmaTqiAndClass) {
  Geometry g = grid(1601);
  g.add("alignment_left_d1", "mm", 1e-3, "");
  g.add("gauge", "mm", 1e-3, "");
  for (std::size_t i = 0; i < g.size(); ++i) {
    g.columns[0].value[i] = 0.002 * std::sin(2 * std::numbers::pi * g.mileage[i] / 10.0);
    g.columns[1].value[i] = 1.435 + 0.001 * std::sin(2 * std::numbers::pi * g.mileage[i] / 8.0);
  }
  const auto q = *assess(g, profile(), 40.0);
  ASSERT_EQ(q.sections.size(), 2u);
  EXPECT_NEAR(q.sections[0].sigma[0].second, 0.002 / std::sqrt(2.0), 2e-6);
  EXPECT_NEAR(q.sections[1].tqi, 0.003 / std::sqrt(2.0), 4e-6);
  EXPECT_EQ(q.sections[0].classes[0].second, "B");
  EXPECT_EQ(q.sections[0].over, (std::vector<std::string>{"AL of alignment_left_d1", "TQI"}));
}

TEST(Quality, CantAndItsRampAreNoIrregularity) {
  // 100 mm of cant built up over 100 m within a section, and irregularities of 1 mm: only these count.
  const std::size_t n = 3201;
  Geometry design = grid(n), bare = grid(n);
  std::vector<double> cant(n), irregular(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double s = design.mileage[i];
    cant[i] = 0.1 * std::clamp((s - 250.0) / 100.0, 0.0, 1.0);
    irregular[i] = 0.001 * std::sin(2 * std::numbers::pi * s / 10.0);
  }
  for (Geometry* g : {&design, &bare}) {
    for (const char* name : {"cross_level", "twist_3m"}) g->add(name, "mm", 1e-3, "");
    for (std::size_t i = 0; i < n; ++i) {
      g->columns[0].value[i] = cant[i] + irregular[i];
      g->columns[1].value[i] =
          i < 12 ? std::nan("") : (cant[i] + irregular[i] - cant[i - 12] - irregular[i - 12]) / 3.0;
    }
  }
  design.add("cross_level_deviation", "mm", 1e-3, "").value = irregular;
  LimitProfile p = profile();
  p.tqi_columns = {"cross_level", "twist_3m*3"};
  // Twist of a sine over 3 m of a wavelength of 10 m: 2 sin(pi 3 / 10) times its amplitude.
  const double wave = 0.001 / std::sqrt(2.0), want = wave * (1.0 + 2.0 * std::sin(0.3 * std::numbers::pi));
  const Quality with_design = *assess(design, p, 40.0), without = *assess(bare, p, 40.0);
  ASSERT_EQ(with_design.sections.size(), 4u);
  for (const Section& s : with_design.sections) EXPECT_NEAR(s.tqi, want, 0.01 * want);
  EXPECT_NEAR(without.sections[3].tqi, want, 0.02 * want);
  // The ramp itself would add 34 mm; what the filter leaves of its two kinks is below 4 mm.
  EXPECT_LT(without.sections[1].tqi, want + 0.004);
}

}  // namespace
}  // namespace versine::track
