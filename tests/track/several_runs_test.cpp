// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "test_run.hpp"
#include "versine/core/numbers.hpp"
#include "versine/core/units.hpp"
#include "versine/track/calibration.hpp"
#include "versine/track/repeatability.hpp"

namespace versine::track {
namespace {

Geometry rough(double shift, double stretch, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> g(0.0, noise);
  Geometry out;
  for (int i = 0; i < 4000; ++i) {
    out.mileage.push_back(0.25 * i);
    out.time.push_back({});
    out.flags.push_back(0);
  }
  for (const char* name : {"gauge", "twist_3m"}) {
    Column& c = out.add(name, "mm", 1e-3, "");
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double s = out.mileage[i] + shift + stretch * out.mileage[i];
      c.value[i] = 0.001 * std::sin(two_pi * s / 7.3 + (name[0] == 'g')) + 0.002 * std::sin(two_pi * s / 31.0 + 1) +
                   0.001 * std::sin(0.01 * s * s / 40) + g(random);
      c.sigma[i] = static_cast<float>(noise);
    }
  }
  return out;
}

TEST(Repeatability, RunsAreAlignedByCorrelation) {
  const Geometry a = rough(0.0, 0.0, 5e-5, 1), b = rough(0.8, 0.0005, 5e-5, 2);
  const auto shifts = find_shifts(a, b);
  ASSERT_GE(shifts.size(), 4u);
  for (const auto& s : shifts) EXPECT_NEAR(s.shift, 0.8 + 0.0005 * s.mileage, 0.05) << s.mileage;
  const auto r = compare(a, aligned_to(a, b, shifts));
  ASSERT_EQ(r.size(), 2u);
  EXPECT_LT(r[0].p95, 2.5 * std::sqrt(2.0) * 5e-5);
  EXPECT_NEAR(r[0].normalized, 1.0, 0.25);
}

TEST(Calibration, PassesInBothOrientationsGiveTheMounting) {
  const auto projection = *geodesy::Projection::create("EPSG:25832");
  test::Track track;
  track.vertical = [](double s) { return 0.01 * std::sin(two_pi * s / 40); };
  const test::Builder builder(track, projection);
  const geodesy::Euler truth{0.02 * units::deg, -0.03 * units::deg, 0.05 * units::deg};
  std::vector<AttitudeLine> with_design, without;
  for (const double direction : {1.0, -1.0}) {
    auto run = builder.run(20, 600, 0.05, direction, direction);
    for (auto& p : run.trajectory.samples) p.q_nb = p.q_nb * geodesy::to_quaternion(truth);  // C_nb = C_nv C_vb
    // The IMU's point stays; only its axes are turned in the trolley.
    GeometryInput input;
    input.trajectory = &run.trajectory;
    input.trolley = run.trolley;
    input.design = &track.design;
    SilentProgress progress;
    with_design.push_back(*attitude_line(input, {}, progress));
  }
  const auto c = calibrate_mounting(with_design, {});
  ASSERT_TRUE(c) << c.error().message();
  // Ramps, an arc and cant are part of the stretch.
  EXPECT_NEAR(c->mounting.roll, truth.roll, 5e-6);
  EXPECT_NEAR(c->mounting.pitch, truth.pitch, 8e-6);
  EXPECT_NEAR(c->mounting.yaw, truth.yaw, 5e-6);
  EXPECT_GT(c->length, 300.0);
  EXPECT_FALSE(calibrate_mounting({with_design[0], with_design[0]}, {}));
}

}  // namespace
}  // namespace versine::track
