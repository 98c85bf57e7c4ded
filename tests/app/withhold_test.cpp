// SPDX-License-Identifier: Apache-2.0
#include "versine/app/withhold.hpp"

#include <gtest/gtest.h>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::app {
namespace {

constexpr geodesy::Geodetic place{0.8, 0.2, 100.0};

Series<sensors::GnssSample> fixes(double north_error) {
  Series<sensors::GnssSample> out;
  for (int k = 0; k <= 300; ++k) {
    sensors::GnssSample s;
    s.time = Time::from_seconds(k);
    s.position = geodesy::wgs84.displaced(place, {10.0 * k + north_error, 0, 0});
    s.sigma_ned.setConstant(0.01);
    out.samples.push_back(s);
  }
  return out;
}

TEST(Withhold, ThreeWholeWindowsAreHiddenAndCompared) {
  auto gnss = fixes(0.03);
  const auto hidden = withhold(gnss, {.window = 60.0, .every = 80.0, .start = 50.0});
  EXPECT_EQ(hidden.size(), 180u);
  EXPECT_EQ(gnss.size(), 121u);
  geodesy::Trajectory track;
  for (int k = 0; k <= 3000; ++k) {
    geodesy::TrajectoryPoint p;
    p.time = Time::from_seconds(0.1 * k);
    p.position = geodesy::wgs84.displaced(place, {k * 1.0, 0, 0});
    track.samples.push_back(p);
  }
  const auto errors = compare_withheld(hidden, track, Eigen::Vector3d::Zero());
  EXPECT_EQ(errors.windows, 3u);
  EXPECT_EQ(errors.count, 180u);
  EXPECT_NEAR(errors.rms_horizontal, 0.03, 1e-5);
  EXPECT_NEAR(errors.coverage, 0.5, 1e-9);  // north is 3 sigma off, east exact
}

}  // namespace
}  // namespace versine::app
