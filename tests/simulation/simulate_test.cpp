// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "support/trolley_scenario.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/simulation/allan.hpp"
#include "versine/simulation/imu.hpp"
#include "versine/simulation/world.hpp"
#include "versine/stationing/free_station.hpp"

namespace versine::simulation {
namespace {
using Eigen::Vector3d;

TEST(Simulate, IsReproducibleAndIndependentOfThreads) {
  Scenario s = trolley_on(60.0, 1.0, 20.0);
  s.equipment.gnss = GnssModel{.multipath_per_h = 60.0, .wrong_fix_per_h = 60.0};
  s.equipment.odometers = {{.scale = 1e-4, .slip_per_km = 100.0}};
  const auto world = prepare(s);
  ASSERT_TRUE(world) << world.error().message();
  const auto a = observe(**world, 7), b = observe(**world, 7), c = observe(**world, 8);
  EXPECT_EQ(a.imu.back().dtheta, b.imu.back().dtheta);
  EXPECT_EQ(a.gnss.back().position, b.gnss.back().position);
  EXPECT_EQ(a.odometers[0].back().distance, b.odometers[0].back().distance);
  EXPECT_NE(a.imu.back().dtheta, c.imu.back().dtheta);
  SilentProgress progress;
  std::vector<double> one(6), two(6);
  simulate_runs(
      **world, 3, 6, 1, [&](auto run, auto&& r) { one[run] = r.imu.back().dvel.x(); }, progress);
  simulate_runs(
      **world, 3, 6, 2, [&](auto run, auto&& r) { two[run] = r.imu.back().dvel.x(); }, progress);
  EXPECT_EQ(one, two);
  // Another sensor does not change this one.
  s.equipment.gnss.reset();
  EXPECT_EQ(simulate(s, 7)->imu.back().dtheta, a.imu.back().dtheta);
}

TEST(Simulate, OneHourOfTrolleyHasEverySample) {
  Scenario s = trolley_on(3400.0, 1.0, 180.0);
  s.equipment.odometers = {{}, {.wheel = OdometerModel::Wheel::a3}};
  s.equipment.gauge = GaugeModel{};
  s.equipment.total_station = TotalStationModel{};
  const auto r = simulate(s, 1);
  ASSERT_TRUE(r) << r.error().message();
  // 180 s standing, 3390 m at 1 m/s with a smooth start and stop, 10 s standing; 200 Hz.
  const double expected = 180.0 + 3390.0 + 10.0;
  EXPECT_NEAR(static_cast<double>(r->imu.size()) / 200.0, expected, 10.0);
  EXPECT_EQ(r->odometers.size(), 2U);
}

TEST(Simulate, AllanDeviationRecoversTheInstrument) {
  // 576,000 samples standing; each grade's own walk, and its instability as flicker.
  for (const char* name : {"navigation-rlg", "fog", "tactical", "mems"}) {
    const auto errors = sensors::find_imu_grade(name)->errors;
    for (const bool gyro : {true, false}) {
      const auto& triad = gyro ? errors.gyro : errors.accelerometer;
      // Averaging time at which walk and floor are equal: the rate is chosen so that both can be seen.
      const double knee = std::pow(triad.random_walk / (0.664 * triad.bias_instability), 2);
      const double rate = std::min(400.0 / knee, 1000.0), step = 1.0 / rate;
      ImuModel model{.rate = rate, .errors = errors, .instability = ImuModel::Instability::flicker};
      sensors::ImuSeries still;
      still.interval = Duration::from_seconds(step);
      for (int k = 1; k <= 576000; ++k) still.samples.push_back({Time{still.interval.ns * k}});
      Truth truth;
      const auto imu = with_errors(
          still, model, {}, [](double) { return 0.0; }, Time{}, 5, truth);
      double walk = 0.0, floor = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> x;
        for (const auto& s : imu) x.push_back(gyro ? s.dtheta(axis) : s.dvel(axis));
        const auto curve = allan_deviation(x, step);
        walk += random_walk_of(curve, step, 0.02 * knee) / 3.0;
        floor += bias_instability_of(curve, 576000.0 * step) / 3.0;
      }
      EXPECT_NEAR(walk / triad.random_walk, 1.0, 0.05) << name << (gyro ? " gyro" : " accelerometer");
      EXPECT_NEAR(floor / triad.bias_instability, 1.0, 0.2) << name << (gyro ? " gyro" : " accelerometer");
      RecordProperty(std::string(name) + (gyro ? "_gyro" : "_accelerometer"),
                     std::to_string(walk / triad.random_walk) + " " + std::to_string(floor / triad.bias_instability));
    }
  }
}

TEST(Odometer, CountsTheWayOfItsOwnRail) {
  Scenario s = trolley_on(200.0, 1.5, 5.0);
  s.track.height = 0.0;
  s.track.spectrum = Spectrum::none;
  s.equipment.odometers = {
      {}, {.wheel = OdometerModel::Wheel::a3}, {.output = OdometerModel::Output::pulses, .quantum = 0.0025}};
  const auto r = simulate(s, 1);
  ASSERT_TRUE(r) << r.error().message();
  const double a1 = r->odometers[0].back().distance, a3 = r->odometers[1].back().distance;
  // 190 m on the axis, 95 m of it in an arc to the right with R = 800 m: the left rail is longer by gauge times angle.
  EXPECT_NEAR(a1 - a3, 1.435 * 95.0 / 800.0, 0.002);
  EXPECT_NEAR(0.5 * (a1 + a3), 190.0, 0.0005);  // on the ellipsoid; 100 m above it the ground is 3 mm longer
  EXPECT_NEAR(r->odometers[2].back().distance, a1, 0.0026);
  for (std::size_t i = 1; i < r->odometers[2].size(); ++i) {
    EXPECT_LT(r->odometers[2][i - 1].time, r->odometers[2][i].time);
  }
}

TEST(Gauge, ReadsChenEquationOneWithTheCurveCorrection) {
  Scenario s = trolley_on(200.0, 1.5, 5.0);
  s.track.alignment.horizontal =
      *design::HorizontalAxis::chain({510000.0, 5300000.0, 0.7}, {design::arc(200.0, 150.0)});
  s.track.spectrum = Spectrum::none;
  s.equipment.temperature.start = 30.0;
  s.trolley.gauge_temperature_factor = 1e-5;
  s.equipment.gauge = GaugeModel{.noise = 0.0};
  const auto r = simulate(s, 1);
  ASSERT_TRUE(r) << r.error().message();
  // d = d1 + d2 + dd + K T, dd = R - sqrt(R^2 - d_w^2 / 4) = 1.2 mm; the reference rail is the outer one here.
  const double dd = 150.7175 - std::sqrt(150.7175 * 150.7175 - 0.36);
  EXPECT_NEAR(r->gauge[100].reading, 0.0 - 3e-4 - dd, 2e-6);
}

TEST(Gnss, ErrorsHaveTheToldSizeAndOutagesAreKept) {
  Scenario s = trolley_on(3000.0, 3.0, 60.0);
  s.equipment.gnss =
      GnssModel{.rate = 5.0, .correlation_time = 5.0, .sigma_factor = 2.0, .outages = {{1000.0, 1200.0}}};
  s.equipment.gnss->refix_time = 1e-3;
  s.equipment.imu.reset();
  const auto world = prepare(s);
  ASSERT_TRUE(world) << world.error().message();
  const auto r = observe(**world, 2);
  double square = 0.0, count = 0.0;
  for (std::size_t i = 0; i < r.gnss.size(); ++i) {
    if (r.gnss[i].fix != sensors::FixType::fixed) continue;
    square += r.truth.gnss_error[i].x() * r.truth.gnss_error[i].x();
    count += 1.0;
  }
  EXPECT_NEAR(std::sqrt(square / count), std::hypot(0.010, 0.008), 0.001);
  EXPECT_NEAR(r.gnss[50].sigma_ned.x(), 0.5 * std::hypot(0.010, 0.008), 1e-12);  // too optimistic by 2
  for (const auto& g : r.gnss) {
    const double at = (*world)->motion((g.time - s.start).seconds()).distance;
    EXPECT_FALSE(at >= 1000.0 && at <= 1200.0);
  }
}

TEST(TotalStation, ReadingsLeadBackToTheInstrument) {
  Scenario s = trolley_on(400.0, 1.5, 30.0);
  s.motion.legs[0].stop_every = 60.0, s.motion.legs[0].stop_each = 20.0;
  s.equipment.total_station = TotalStationModel{.output = TotalStationModel::Output::both};
  s.equipment.total_station->mounting = {0.01, -0.02, 0.5};
  const auto world = prepare(s);
  ASSERT_TRUE(world) << world.error().message();
  const auto r = observe(**world, 2);
  ASSERT_EQ(r.stationings.size(), 7U);
  ASSERT_EQ(r.landmarks.size(), 7U);
  const stationing::Instrument instrument{.target_sigma = 0.0};
  const auto network = stationing::ControlNetwork::create(r.control_points);
  ASSERT_TRUE(network) << network.error().message();
  double sum = 0.0;
  for (const auto& station : r.stationings) {
    const auto reduced = stationing::reduce(station, instrument);
    ASSERT_TRUE(reduced) << reduced.error().message();
    const auto result = stationing::free_station(*reduced, *network, instrument, {});
    ASSERT_TRUE(result) << result.error().message();
    const double t = 0.5 * ((*station.from - s.start).seconds() + (*station.to - s.start).seconds());
    const Vector3d truth = (*world)->point(t, s.equipment.total_station->place);
    EXPECT_LT((result->position - truth).norm(), 1.5e-3);
    // The attitude within what its own covariance allows: chi-square of 3 at 5e-5, seven stations.
    const Eigen::AngleAxisd turn(
        result->q_ms.toRotationMatrix() *
        ((*world)->C_lv(t) * geodesy::to_matrix(s.equipment.total_station->mounting)).transpose());
    const Vector3d error = turn.angle() * turn.axis();
    const Eigen::Matrix3d covariance = result->covariance.block<3, 3>(3, 3);
    const double squared = error.dot(covariance.llt().solve(error));
    EXPECT_LT(squared, 22.0);
    EXPECT_LT(error.norm(), 1.5e-4);
    sum += squared;
  }
  // 21 degrees of freedom: 0.1 % to 99.9 %.
  EXPECT_GT(sum, 5.9);
  EXPECT_LT(sum, 46.8);
}

TEST(Check, NamesTheKeyAndTheCure) {
  const auto key_of = [](const Scenario& s) {
    const auto result = prepare(s);
    return result ? std::string("good") : result.error().field;
  };
  Scenario s = trolley_on(200.0, 1.0, 10.0);
  EXPECT_EQ(key_of(s), "good");
  s.motion.legs[0].speed = 0.0;
  EXPECT_EQ(key_of(s), "motion.leg[0].speed_kmh");
  s = trolley_on(200.0, 1.0, 10.0);
  s.motion.legs[0].to = 300.0;
  EXPECT_EQ(key_of(s), "motion.leg[0].to_m");
  s = trolley_on(200.0, 1.0, 10.0);
  s.track.alignment.cant = *design::CantProfile::from_points({{0.0, 0.0}, {50.0, 0.2}});
  EXPECT_EQ(key_of(s), "track.cant[1].cant_mm");
  s = trolley_on(200.0, std::nan(""), 10.0);
  EXPECT_EQ(key_of(s), "motion.leg[0].speed_kmh");
}

TEST(Faults, DoWhatTheySay) {
  Scenario s = trolley_on(100.0, 1.0, 10.0);
  s.equipment.faults = {{Fault::Kind::gap, Fault::Sensor::imu, 5.0, 2.0, 0.0},
                        {Fault::Kind::duplicate, Fault::Sensor::imu, 12.0, 1.0, 0.0},
                        {Fault::Kind::stuck, Fault::Sensor::imu, 20.0, 1.0, 0.0},
                        {Fault::Kind::not_a_number, Fault::Sensor::imu, 30.0, 0.1, 0.0},
                        {Fault::Kind::clock_step, Fault::Sensor::imu, 40.0, 1.0, 0.5}};
  const auto r = simulate(s, 1);
  ASSERT_TRUE(r) << r.error().message();
  ASSERT_EQ(r->faults.size(), 5U);
  EXPECT_EQ(r->faults[0].count, 400U);
  EXPECT_FALSE(r->imu.strictly_increasing());
  std::size_t nan = 0;
  for (const auto& x : r->imu) nan += std::isnan(x.dtheta.x()) ? 1 : 0;
  EXPECT_EQ(nan, 20U);
}

TEST(Rails, HaveTheirGaugeAndCrossLevel) {
  Scenario s = trolley_on(400.0, 1.0, 10.0);
  s.track.alignment.cant = *design::CantProfile::from_points({{0.0, 0.0}, {100.0, 0.0}, {200.0, 0.12}, {400.0, 0.12}});
  s.track.spectrum = Spectrum::german_low;
  s.equipment.imu.reset();
  const auto r = simulate(s, 1);
  ASSERT_TRUE(r) << r.error().message();
  for (std::size_t i = 0; i < r->truth.rails.distance.size(); i += 13) {
    const geodesy::LocalFrame here(r->truth.rails.left[i]);
    const Vector3d across = here.to_ned(r->truth.rails.right[i]);
    EXPECT_NEAR(across.norm(), r->truth.rails.gauge[i], 1e-8);
    // Height of the left rail over the right one, per gauge, is cross level per 1.5 m.
    EXPECT_NEAR(across.z() / across.norm(), r->truth.rails.cross_level[i] / 1.5, 1e-6);
  }
}

}  // namespace
}  // namespace versine::simulation
