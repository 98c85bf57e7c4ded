// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/inertial/mechanization.hpp"
#include "versine/simulation/body.hpp"
#include "versine/simulation/imu.hpp"
#include "versine/simulation/motion.hpp"

namespace versine::simulation {
namespace {
using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

/// Straight rails along x in a flat frame with the given deviations of the left rail (lateral, down).
UniformSpline<6> rails_with(const std::function<std::pair<double, double>(double)>& left, double length = 60.0) {
  const double step = 0.05;
  UniformSpline<6>::Samples samples(6, static_cast<Eigen::Index>(length / step));
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    const double s = step * static_cast<double>(i);
    const auto [lateral, down] = left(s);
    samples.col(i) << s, -0.7175 + lateral, down, s, 0.7175, 0.0;
  }
  return {0.0, step, samples};
}

TEST(TrolleyContact, ThreeWheelsOnALevelSineOfOneRail) {
  // Left rail z = a sin(k s): with the axles d apart the pitch follows the chord, exactly
  // -(z1 - z2) / d, gain sinc; the roll follows the mean of both wheels against the right rail.
  const double a = 2e-3;
  for (const double wavelength : {1.5, 3.0, 7.0, 20.0}) {
    const double k = 2 * pi / wavelength;
    const auto rails = rails_with([&](double s) { return std::pair{0.0, a * std::sin(k * s)}; });
    track::Trolley trolley;
    for (double s = 10.0; s < 40.0; s += 0.73) {
      const TrolleyContact c = touch(rails, trolley, s, 1.0);
      const geodesy::Euler e = geodesy::to_euler(c.pose.axes);
      const double d = trolley.wheelbase();
      EXPECT_NEAR(e.pitch, -2 * a * std::cos(k * s) * std::sin(k * d / 2) / d, 5e-8);
      const double mean = a * std::sin(k * s) * std::cos(k * d / 2);
      EXPECT_NEAR(e.roll, std::asin(-mean / 1.435), 1e-8);
      EXPECT_NEAR(c.pose.origin.z(),
                  mean + std::cos(e.pitch) * (0.7175 * std::sin(e.roll) - trolley.contact_z * std::cos(e.roll)), 1e-8);
    }
  }
}

TEST(TrolleyContact, AlignmentSineTurnsTheTrolleyAndShortensTheGauge) {
  const double a = 3e-3, wavelength = 6.0, k = 2 * pi / wavelength;
  const auto rails = rails_with([&](double s) { return std::pair{a * std::sin(k * s), 0.0}; });
  track::Trolley trolley;
  for (double s = 10.0; s < 40.0; s += 0.73) {
    const TrolleyContact c = touch(rails, trolley, s, 1.0);
    const double d = trolley.wheelbase();
    EXPECT_NEAR(geodesy::to_euler(c.pose.axes).yaw, 2 * a * std::cos(k * s) * std::sin(k * d / 2) / d, 2e-8);
    EXPECT_NEAR(c.gauge, 1.435 - a * std::sin(k * s) * std::cos(k * d / 2), 1e-5);  // 1 / cos(yaw): 3e-6 of it
  }
}

TEST(TrolleyContact, FacingBackPutsTheReferenceOnTheOtherRail) {
  const auto rails = rails_with([](double) { return std::pair{0.0, 0.015}; });  // left rail 15 mm low
  const TrolleyContact there = touch(rails, {}, 20.0, 1.0), back = touch(rails, {}, 20.0, -1.0);
  EXPECT_NEAR(geodesy::to_euler(there.pose.axes).roll, -0.015 / 1.435, 1e-6);
  EXPECT_NEAR(geodesy::to_euler(back.pose.axes).roll, 0.015 / 1.435, 1e-6);
  EXPECT_NEAR(std::abs(geodesy::to_euler(back.pose.axes).yaw), pi, 1e-9);
  track::Trolley other;
  other.reference_y = 0.7175;
  EXPECT_NEAR(touch(rails, other, 20.0, 1.0).pose.axes(2, 2), there.pose.axes(2, 2), 1e-9);
}

TEST(SpeedProfile, ArrivesAndIsSmooth) {
  Motion motion;
  motion.start = 5.0;
  motion.stand = 20.0;
  motion.unevenness = 0.1;
  motion.legs = {{.to = 205.0, .speed = 1.5, .acceleration = 0.3, .stop = 10.0, .stop_every = 60.0, .stop_each = 15.0},
                 {.to = 100.0, .speed = 3.0, .acceleration = 0.4, .stop = 5.0}};
  const auto profile = SpeedProfile::create(motion, 0.0, 300.0, 3);
  ASSERT_TRUE(profile) << profile.error().message();
  ASSERT_EQ(profile->stops().size(), 6U);
  EXPECT_NEAR(profile->stops()[1].distance, 65.0, 1e-12);
  for (const Stop& stop : profile->stops()) {
    EXPECT_EQ(profile->at(0.5 * (stop.from + stop.to)).speed, 0.0);
    EXPECT_NEAR(profile->at(stop.to - 1e-6).distance, stop.distance, 1e-9);
  }
  EXPECT_NEAR(profile->at(profile->duration()).distance, 100.0, 1e-9);
  for (double t = 1.0; t < profile->duration() - 1.0; t += 0.317) {
    const double h = 1e-3;
    const MotionState m = profile->at(t);
    EXPECT_NEAR(m.speed, (profile->at(t + h).distance - profile->at(t - h).distance) / (2 * h), 1e-6);
    EXPECT_NEAR(m.acceleration, (profile->at(t + h).speed - profile->at(t - h).speed) / (2 * h), 1e-5);
  }
}

/// Error-free increments, put together again by Versine's own mechanisation: largest distance to the truth, m.
double closure(const Rails& rails, const track::Trolley& trolley, const Motion& motion, double seconds) {
  const auto profile = SpeedProfile::create(motion, rails.begin, rails.end, 1);
  EXPECT_TRUE(profile) << profile.error().message();
  const Body body(rails, trolley, {}, motion.facing_back ? -1.0 : 1.0, profile->reach());
  const auto& origin = rails.frame.origin();
  const Vector3d w_ie_l =
      geodesy::rotation_en(origin.latitude, origin.longitude).transpose() * Vector3d(0, 0, geodesy::wgs84.omega());
  const auto state = [&](double t) { return body.at(profile->at(t)); };
  const Time start{1'000'000'000'000'000'000};
  const auto imu = ideal_imu(state, w_ie_l, std::min(seconds, profile->duration()), 200.0, start);
  const auto nav = [&](double t) {
    const BodyState s = state(t);
    const geodesy::Geodetic g = rails.frame.to_geodetic(s.position);
    const Eigen::Matrix3d C_nl = rails.frame.rotation_from(g).transpose();
    inertial::NavState n;
    n.time = start + Duration::from_seconds(t);
    n.position = g;
    n.v_eb_n = C_nl * s.velocity;
    n.q_nb = Eigen::Quaterniond(Eigen::Matrix3d(C_nl * s.C_lb));
    return n;
  };
  double worst = 0.0;
  for (const inertial::NavState& n : inertial::integrate(nav(0.0), imu)) {
    const geodesy::Geodetic truth = rails.frame.to_geodetic(state((n.time - start).seconds()).position);
    worst = std::max(worst, geodesy::wgs84.ned_difference(truth, n.position).norm());
  }
  return worst;
}

TrackModel track_with(std::vector<design::HorizontalElement> elements, std::vector<design::CantPoint> cant,
                      Spectrum spectrum) {
  TrackModel track;
  track.alignment.crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
  track.alignment.horizontal = *design::HorizontalAxis::chain({510000.0, 5300000.0, 0.7}, std::move(elements));
  if (!cant.empty()) track.alignment.cant = *design::CantProfile::from_points(std::move(cant));
  track.alignment.profile = design::Profile::constant(0.0, 420.0, 0.012, track.alignment.length());
  track.spectrum = spectrum;
  return track;
}

TEST(IdealImu, IntegratesBackOnAStraight) {
  const auto rails = build_rails(track_with({design::line(900.0)}, {}, Spectrum::german_low));
  ASSERT_TRUE(rails);
  Motion motion{.start = 10.0, .stand = 30.0, .legs = {{.to = 800.0, .speed = 1.5, .stop = 30.0}}, .unevenness = 0.1};
  const double error = closure(*rails, {}, motion, 600.0);
  RecordProperty("error_mm", std::to_string(error * 1e3));
  EXPECT_LT(error, 1e-4);
}

TEST(IdealImu, IntegratesBackThroughATightCantedCurve) {
  const auto track = track_with(
      {design::line(100.0), design::transition(design::Shape::clothoid, 60.0, inf, 150.0), design::arc(400.0, 150.0),
       design::transition(design::Shape::bloss, 60.0, 150.0, inf), design::line(300.0)},
      {{100.0, 0.0}, {160.0, 0.150}, {560.0, 0.150}, {620.0, 0.0}}, Spectrum::german_high);
  const auto rails = build_rails(track);
  ASSERT_TRUE(rails);
  track::Trolley trolley;
  trolley.mounting = {0.01, -0.02, 0.03};
  Motion motion{.start = 10.0, .stand = 30.0, .legs = {{.to = 850.0, .speed = 3.0, .stop = 300.0}}, .unevenness = 0.1};
  const double error = closure(*rails, trolley, motion, 600.0);
  RecordProperty("error_mm", std::to_string(error * 1e3));
  EXPECT_LT(error, 1e-4);
}

TEST(IdealImu, IntegratesBackOverAReversal) {
  const auto track = track_with(
      {design::line(100.0), design::transition(design::Shape::clothoid, 60.0, inf, -300.0), design::arc(300.0, -300.0)},
      {{100.0, 0.0}, {160.0, -0.1}, {460.0, -0.1}}, Spectrum::german_low);
  const auto rails = build_rails(track);
  ASSERT_TRUE(rails);
  Motion motion{.start = 10.0,
                .facing_back = true,
                .stand = 10.0,
                .legs = {{.to = 400.0, .speed = 1.5, .stop = 10.0},
                         {.to = 50.0, .speed = 5.0, .stop = 10.0},
                         {.to = 400.0, .speed = 2.0, .stop = 100.0}}};
  const double error = closure(*rails, {}, motion, 600.0);
  RecordProperty("error_mm", std::to_string(error * 1e3));
  EXPECT_LT(error, 1e-4);
}

}  // namespace
}  // namespace versine::simulation
