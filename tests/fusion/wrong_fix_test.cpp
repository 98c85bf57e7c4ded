// SPDX-License-Identifier: Apache-2.0
// Wrong carrier-phase ambiguities: fixes that are off by decimetres to metres for seconds, with the sigma of a good one
// (Chen 2018, 4.2). Innovation filtering has to find them.
#include <gtest/gtest.h>

#include "fusion/scenario.hpp"

namespace versine::fusion {
namespace {
using Eigen::Vector3d;

/// A trolley at walking speed with odometer, navigation-grade IMU and fixes of 1 cm.
test::Scenario trolley() {
  test::Scenario s;
  s.motion.speed = 1.5, s.motion.swing = 0.3, s.motion.turn = 0.2;
  s.duration = 240.0;
  s.errors = sensors::find_imu_grade("navigation-rlg")->errors;
  s.gnss_sigma = 0.01, s.gnss_velocity_sigma = 0.02;
  return s;
}

struct Outcome {
  std::size_t wrong = 0, found = 0, good = 0, lost = 0, inside = 0, points = 0;
  double largest = 0.0;  ///< position error while the fixes are wrong and after, m
};

/// Adds `offset` to the fixes of `seconds` from 120 s on; their Doppler velocity stays right.
Outcome run(const test::Scenario& s, const Vector3d& offset, double seconds, unsigned seed) {
  test::Simulated made = test::make(s, seed);
  const auto at = [&](Time t) { return (t - s.motion.epoch).seconds(); };
  const auto wrong = [&](Time t) { return at(t) > 120.0 && at(t) <= 120.0 + seconds; };
  Outcome o;
  for (auto& g : made.input.gnss.samples) {
    if (!wrong(g.time)) continue;
    g.position = geodesy::wgs84.displaced(g.position, offset);
    ++o.wrong;
  }
  made.options.output_rate = 10.0;
  SilentProgress progress;
  SilentLog log;
  const auto r = run_aided_ins(made.input, made.options, progress, log);
  if (!r) throw std::runtime_error(r.error().message());
  for (const auto& x : r->solution.record.rejections) {
    if (x.sensor == "gnss position") wrong(x.time) ? ++o.found : ++o.lost;
  }
  o.good = made.input.gnss.size() - o.wrong;
  for (const auto& p : r->solution.smoothed) {
    if (at(p.time) < 100.0) continue;
    const Vector3d e = test::error_at(p, test::truth_at(s, made.truth, at(p.time))).position;
    o.largest = std::max(o.largest, e.norm());
    const Vector3d sigma = p.position_covariance.matrix().diagonal().cwiseSqrt();
    for (int k = 0; k < 3; ++k) o.inside += std::abs(e[k]) < 3.0 * sigma[k], ++o.points;
  }
  return o;
}

TEST(WrongFix, IsFoundAndLeavesNothingBehind) {
  const test::Scenario s = trolley();
  std::printf("| off by, m | for, s | wrong fixes found | good fixes lost | largest error, mm | within 3 sigma |\n");
  for (const double size : {0.2, 0.5, 1.0, 3.0}) {
    for (const double seconds : {3.0, 8.0, 30.0}) {
      Outcome sum;
      for (const unsigned seed : {11U, 12U}) {
        const Vector3d direction = seed == 11U ? Vector3d(0.6, -0.5, 0.62) : Vector3d(-0.3, 0.4, -0.866);
        const Outcome o = run(s, size * direction.normalized(), seconds, seed);
        EXPECT_EQ(o.found, o.wrong) << size << " m for " << seconds << " s";
        EXPECT_LE(o.lost, 1U);
        EXPECT_GT(double(o.inside) / double(o.points), 0.98) << size << " m for " << seconds << " s";
        sum.wrong += o.wrong, sum.found += o.found, sum.good += o.good, sum.lost += o.lost;
        sum.inside += o.inside, sum.points += o.points, sum.largest = std::max(sum.largest, o.largest);
      }
      std::printf("| %.1f | %.0f | %zu of %zu | %zu of %zu | %.1f | %.1f %% |\n", size, seconds, sum.found, sum.wrong,
                  sum.lost, sum.good, 1e3 * sum.largest, 100.0 * double(sum.inside) / double(sum.points));
    }
  }
}

}  // namespace
}  // namespace versine::fusion
