// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/sensors/imu_check.hpp"
#include "versine/sensors/plausibility.hpp"
#include "versine/sensors/series_check.hpp"

namespace versine::sensors {
namespace {

constexpr std::int64_t ms = 1'000'000;

// A vehicle that stands for a fifth of the time and then weaves along, 100 Hz, with sensor noise.
ImuSeries drive(std::size_t count = 6000) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  ImuSeries imu;
  imu.interval = {10 * ms};
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double rate = t > 0.002 * static_cast<double>(count) ? 0.3 * std::sin(0.2 * t) : 0.0;
    ImuSample s{.time = {static_cast<std::int64_t>(i) * 10 * ms}};
    for (int k = 0; k < 3; ++k) s.dtheta[k] = 1e-5 * noise(random), s.dvel[k] = 1e-4 * noise(random);
    s.dtheta.z() += 0.01 * rate;
    s.dvel += 0.01 * Eigen::Vector3d(0.0, 10.0 * rate, -9.81);
    imu.samples.push_back(s);
  }
  return imu;
}

// GNSS of the same drive: 10 m/s once it moves.
Series<GnssSample> fixes_of(const ImuSeries& imu) {
  Series<GnssSample> gnss;
  gnss.scale = imu.scale;
  geodesy::Geodetic g{0.9, 0.2, 100.0};
  double heading = 0.4;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    heading += imu[i].dtheta.z();
    const double speed = i > imu.size() / 5 ? 10.0 : 0.0;
    const Eigen::Vector3d v(speed * std::cos(heading), speed * std::sin(heading), 0.0);
    g = geodesy::wgs84.displaced(g, 0.01 * v);
    if (i % 100 == 0) {
      gnss.samples.push_back({.time = imu[i].time,
                              .position = g,
                              .sigma_ned = {0.02, 0.02, 0.05},
                              .v_ned = v,
                              .sigma_v_ned = {0.05, 0.05, 0.05}});
    }
  }
  return gnss;
}

const Finding* find(const RunRecord& record, std::string_view kind) {
  for (const Finding& f : record.findings) {
    if (f.kind == kind) return &f;
  }
  return nullptr;
}

Eigen::Vector3d sum(const ImuSeries& imu) {
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu) total += s.dtheta;
  return total;
}

TEST(ImuCheck, GoodDataPassUnchanged) {
  const auto checked = check_imu(drive());
  ASSERT_TRUE(checked);
  EXPECT_EQ(checked->series.size(), 6000u);
  EXPECT_EQ(checked->segments.size(), 1u);
  EXPECT_TRUE(checked->record.findings.empty());
  EXPECT_EQ(sum(checked->series), sum(drive()));
}

TEST(ImuCheck, UpToThreeMissingSamplesAreInterpolated) {
  for (const std::size_t missing : {1u, 2u, 3u}) {
    ImuSeries imu = drive();
    const double before = sum(imu).z();
    imu.samples.erase(imu.samples.begin() + 3000, imu.samples.begin() + 3000 + static_cast<std::ptrdiff_t>(missing));
    const auto checked = check_imu(imu);
    ASSERT_TRUE(checked);
    EXPECT_EQ(checked->series.size(), 6000u);
    EXPECT_EQ(checked->segments.size(), 1u);
    EXPECT_TRUE(checked->series.strictly_increasing());
    EXPECT_NEAR(sum(checked->series).z(), before, 1e-4);
    const Finding* gap = find(checked->record, "gap");
    ASSERT_NE(gap, nullptr);
    EXPECT_EQ(gap->count, missing);
    EXPECT_EQ(gap->action, Finding::Action::repaired);
  }
}

TEST(ImuCheck, LongerGapsSplitTheRun) {
  ImuSeries imu = drive();
  imu.samples.erase(imu.samples.begin() + 3000, imu.samples.begin() + 3200);  // 2 s
  const auto checked = check_imu(imu);
  ASSERT_TRUE(checked);
  ASSERT_EQ(checked->segments.size(), 2u);
  EXPECT_EQ(checked->segments[1].begin, 3000u);
  EXPECT_EQ(checked->segments[1].end, 5800u);
  EXPECT_EQ(find(checked->record, "gap")->count, 200u);
  EXPECT_EQ(find(checked->record, "gap")->action, Finding::Action::split);
}

TEST(ImuCheck, RatesBecomeIncrementsOverTheActualInterval) {
  for (const auto content : {ImuContent::mean_rates, ImuContent::rates_at_stamp}) {
    ImuSeries imu = drive();
    imu.content = content;
    for (std::size_t i = 0; i < imu.size(); ++i) {
      imu[i].dtheta = Eigen::Vector3d(0.0, 0.0, 0.01 * 0.25);  // 0.25 rad/s
      imu[i].time.ns += (i % 3 == 0 ? 1 : 0) * ms;             // jitter
    }
    imu.samples.erase(imu.samples.begin() + 2000, imu.samples.begin() + 2002);
    const auto checked = check_imu(imu);
    ASSERT_TRUE(checked);
    const double span = (checked->series.back().time - checked->series.front().time).seconds() + 0.01;
    EXPECT_NEAR(sum(checked->series).z(), 0.25 * span, 1e-12);
  }
}

TEST(ImuCheck, DuplicatedLinesAndStampsThatGoBack) {
  ImuSeries imu = drive();
  imu.samples.insert(imu.samples.begin() + 1000, imu[1000]);
  imu[2000].time.ns += 1'000'000 * ms;  // one stamp far ahead must not cost what follows
  imu[3000].time.ns -= 500 * ms;
  const auto checked = check_imu(imu);
  ASSERT_TRUE(checked);
  EXPECT_EQ(checked->series.size(), 6000u);  // both bad ones interpolated again
  EXPECT_TRUE(checked->series.strictly_increasing());
  EXPECT_EQ(find(checked->record, "duplicate time")->count, 1u);
  ASSERT_NE(find(checked->record, "backward time"), nullptr);
}

TEST(ImuCheck, ImpossibleSamplesAreLeftOut) {
  ImuSeries imu = drive();
  imu[100].dtheta.x() = std::nan("");
  imu[200].dvel.setZero();
  imu[300].dvel.y() = 1e3;
  for (std::size_t i = 4000; i < 4100; ++i) imu[i].dtheta = imu[4000].dtheta, imu[i].dvel = imu[4000].dvel;
  const auto checked = check_imu(imu);
  ASSERT_TRUE(checked);
  for (const char* kind : {"not a number", "null", "out of range"}) {
    ASSERT_NE(find(checked->record, kind), nullptr) << kind;
    EXPECT_EQ(find(checked->record, kind)->count, 1u);
  }
  EXPECT_EQ(find(checked->record, "stuck")->count, 99u);
  EXPECT_EQ(checked->segments.size(), 2u);
  for (const ImuSample& s : checked->series) EXPECT_TRUE(s.dtheta.allFinite() && s.dvel.allFinite());
}

// A standing trolley with 16 bits for 250 deg/s and 2 g and less noise than a count.
TEST(ImuCheck, QuietSensorOfCoarseCountsIsNotStuck) {
  const double angle = 250.0 * units::deg / 32768.0 * 0.01, velocity = 2.0 * 9.81 / 32768.0 * 0.01;
  ImuSeries imu = drive();
  const auto counted = [](const Eigen::Vector3d& x, double count) -> Eigen::Vector3d {
    return count * (x / count).array().round().matrix();
  };
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    if (i < 3000) {  // now and then a count more or less
      imu[i].dtheta = angle * Eigen::Vector3d(noise(random) > 3.2 ? 1 : 0, 0, noise(random) > 3.2 ? -1 : 0);
      imu[i].dvel = 0.01 * Eigen::Vector3d(0.05, -0.02, -9.81);
    }
    imu[i].dtheta = counted(imu[i].dtheta, angle), imu[i].dvel = counted(imu[i].dvel, velocity);
  }
  const auto quiet = check_imu(imu);
  ASSERT_TRUE(quiet);
  EXPECT_EQ(find(quiet->record, "stuck"), nullptr);
  EXPECT_EQ(quiet->segments.size(), 1u);
  // The same sensor that hangs while it moves is found.
  for (std::size_t i = 4500; i < 4600; ++i) imu[i].dtheta = imu[4499].dtheta, imu[i].dvel = imu[4499].dvel;
  const auto hung = check_imu(imu);
  ASSERT_TRUE(hung);
  ASSERT_NE(find(hung->record, "stuck"), nullptr);
  EXPECT_EQ(find(hung->record, "stuck")->count, 100u);
}

TEST(ImuCheck, RefusesWhatItCannotRepair) {
  EXPECT_FALSE(check_imu({}));
  ImuSeries imu = drive();
  for (std::size_t i = 3000; i < 6000; ++i) imu[i].time = imu[i - 3000].time;  // the recorder began anew
  for (std::size_t i = 3000; i < 6000; ++i) imu[i].time.ns += 1;
  const auto restarted = check_imu(imu);
  ASSERT_FALSE(restarted);
  EXPECT_NE(restarted.error().advice.find("split the file"), std::string::npos);
}

TEST(SeriesCheck, MedianFilterTakesIsolatedSpikesOnly) {
  Series<GaugeSample> gauge;
  for (int i = 0; i < 1000; ++i) gauge.samples.push_back({.time = {i * 10 * ms}, .reading = 1e-3 * std::sin(0.02 * i)});
  const auto clean = gauge;
  gauge[500].reading += 0.02;
  gauge[700].reading -= 0.01;
  const auto checked = check_gauge(gauge, {.spike = 0.002});
  ASSERT_TRUE(checked);
  for (std::size_t i = 0; i < 1000; ++i) EXPECT_NEAR(checked->series[i].reading, clean[i].reading, 5e-5);
  EXPECT_EQ(checked->record.findings.size(), 2u);
  const auto untouched = check_gauge(clean, {.spike = 0.002});
  for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(untouched->series[i].reading, clean[i].reading);
}

TEST(SeriesCheck, OdometerAtSpeedHasNoFalseSpikes) {
  Series<OdometerSample> odometer;
  for (int i = 0; i < 1000; ++i) odometer.samples.push_back({{i * 10 * ms}, 0.3 * i});
  odometer[400].distance += 50.0;
  const auto checked = check_odometer(odometer, {.spike = 0.5});
  ASSERT_TRUE(checked);
  ASSERT_EQ(checked->record.findings.size(), 1u);
  EXPECT_NEAR(checked->series[400].distance, 120.0, 0.31);
}

TEST(SeriesCheck, StuckAndOutOfRange) {
  Series<RangeSample> range;
  for (int i = 0; i < 1000; ++i) range.samples.push_back({{i * 10 * ms}, 0.2 + 0.001 * (i % 7)});
  range[10].range = 9.0;
  range[11].range = std::nan("");
  for (std::size_t i = 500; i < 700; ++i) range[i].range = 0.2;
  const auto checked = check_range(range, {.stuck_after = 1.0, .max = 1.0});
  ASSERT_TRUE(checked);
  EXPECT_EQ(find(checked->record, "out of range")->count, 1u);
  EXPECT_EQ(find(checked->record, "not a number")->count, 1u);
  EXPECT_GE(find(checked->record, "stuck")->count, 199u);
}

TEST(GnssCheck, SigmaMustBePositive) {
  for (const double bad : {0.0, -1.0}) {
    auto gnss = fixes_of(drive());
    gnss[5].sigma_ned.y() = bad;
    const auto checked = check_gnss(gnss, {.file = "gnss.csv"});
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().file, "gnss.csv");
    EXPECT_FALSE(checked.error().advice.empty());
  }
}

TEST(GnssCheck, NullFrozenAndWithoutFix) {
  auto gnss = fixes_of(drive());
  const std::size_t count = gnss.size();
  gnss[3].position = {0.0, 0.0, 0.0};
  gnss[4].fix = FixType::none;
  gnss[5].sigma_ned.x() = std::nan("");
  for (std::size_t i = 41; i < 45; ++i) gnss[i].position = gnss[40].position;
  const auto checked = check_gnss(gnss);
  ASSERT_TRUE(checked);
  EXPECT_EQ(checked->series.size(), count - 7);
  EXPECT_EQ(find(checked->record, "stuck")->count, 4u);
}

TEST(Plausibility, TheTruthPasses) {
  const auto imu = check_imu(drive());
  const auto fine = check_imu_plausibility(*imu);
  EXPECT_TRUE(fine) << fine.error().message();
  const auto together = check_gnss_plausibility(&*imu, fixes_of(drive()), "gnss.csv");
  EXPECT_TRUE(together) << together.error().message();
}

std::string advice_for(ImuSeries series) {
  const auto imu = check_imu(std::move(series), {.max_rate = 1e6, .max_acceleration = 1e6});
  if (!imu) return "refused: " + imu.error().message();
  const auto result = check_imu_plausibility(*imu, {.file = "imu.csv"});
  return result ? "passed" : result.error().message();
}

TEST(Plausibility, WrongUnitsOfTheAccelerometers) {
  ImuSeries g = drive(), mps2 = drive(), increments = drive();
  for (auto& s : g.samples) s.dvel /= units::standard_gravity;
  for (auto& s : mps2.samples) s.dvel *= units::standard_gravity;
  for (auto& s : increments.samples) s.dvel *= 0.01;
  EXPECT_NE(advice_for(g).find("accel_x_g"), std::string::npos) << advice_for(g);
  EXPECT_NE(advice_for(mps2).find("accel_x_mps2"), std::string::npos) << advice_for(mps2);
  EXPECT_NE(advice_for(increments).find("dvel_x_mps"), std::string::npos) << advice_for(increments);
}

TEST(Plausibility, WrongAxes) {
  ImuSeries up = drive(), side = drive();
  for (auto& s : up.samples) s.dvel = {s.dvel.y(), s.dvel.x(), -s.dvel.z()};  // right-forward-up, not told
  for (auto& s : side.samples) s.dvel = {s.dvel.z(), s.dvel.x(), s.dvel.y()};
  EXPECT_NE(advice_for(up).find("right-forward-up"), std::string::npos) << advice_for(up);
  EXPECT_NE(advice_for(side).find("axes"), std::string::npos) << advice_for(side);
}

TEST(Plausibility, DegreesDeclaredAsRadians) {
  ImuSeries imu = drive();
  for (auto& s : imu.samples) s.dtheta /= units::deg;
  EXPECT_NE(advice_for(imu).find("degps"), std::string::npos) << advice_for(imu);
}

TEST(Plausibility, CourseTellsUnitsAndSwappedCoordinates) {
  const auto imu = check_imu(drive());
  auto degrees = check_imu(drive());
  for (auto& s : degrees->series.samples) s.dtheta /= units::deg;
  const auto gnss = fixes_of(drive());
  const auto units_wrong = check_gnss_plausibility(&*degrees, gnss, "gnss.csv");
  ASSERT_FALSE(units_wrong);
  EXPECT_NE(units_wrong.error().advice.find("degps"), std::string::npos);
  auto swapped = gnss;
  for (auto& s : swapped.samples) std::swap(s.position.latitude, s.position.longitude), s.v_ned.reset();
  const auto swapped_found = check_gnss_plausibility(&*imu, swapped, "gnss.csv");
  ASSERT_FALSE(swapped_found);
  EXPECT_NE(swapped_found.error().message().find("swapped"), std::string::npos);
  // Without an IMU the receiver's own velocity tells.
  swapped = gnss;
  for (auto& s : swapped.samples) std::swap(s.position.latitude, s.position.longitude);
  EXPECT_FALSE(check_gnss_plausibility(nullptr, swapped, "gnss.csv"));
  EXPECT_TRUE(check_gnss_plausibility(nullptr, gnss, "gnss.csv"));
}

TEST(Plausibility, StandingNavigationGyrosShowTheEarthsRate) {
  const double bias = 0.01 * units::deg_per_hour;
  ImuSeries trolley = drive();
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  const Eigen::Vector3d earth = 7.292e-5 * Eigen::Vector3d(0.5, 0.3, -0.81).normalized();
  for (std::size_t i = 0; i < trolley.size(); ++i) {  // creeps through a curve once it moves
    const Eigen::Vector3d curve(0.0, 0.0, i > 2000 ? 0.003 : 0.0);
    trolley[i].dtheta = 0.01 * (earth + curve) + 1e-8 * Eigen::Vector3d(noise(random), noise(random), noise(random));
  }
  for (std::size_t i = 0; i < 2000; ++i) trolley[i].dvel = 0.01 * Eigen::Vector3d(0.0, 0.0, -9.81);
  auto imu = check_imu(trolley);
  ASSERT_TRUE(check_imu_plausibility(*imu, {.gyro_bias = bias}));
  for (auto& s : imu->series.samples) s.dtheta /= units::deg;
  EXPECT_TRUE(check_imu_plausibility(*imu));  // slow: nothing but the Earth tells
  const auto found = check_imu_plausibility(*imu, {.gyro_bias = bias});
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().advice.find("degps"), std::string::npos);
}

TEST(Plausibility, ShortStraightWayTellsSwappedCoordinates) {
  for (const double course : {0.1, 1.2, 2.0, -3.0}) {
    Series<GnssSample> gnss, swapped;
    Series<OdometerSample> odometer;
    geodesy::Geodetic g{0.9, 0.23, 100.0};
    const Eigen::Vector3d v(0.8 * std::cos(course), 0.8 * std::sin(course), 0.0);
    for (int i = 0; i < 60; ++i) {
      const Time t{1000 * i * ms};
      gnss.samples.push_back({.time = t, .position = g, .sigma_ned = {0.02, 0.02, 0.05}, .v_ned = v});
      swapped.samples.push_back(gnss.samples.back());
      swapped.samples.back().position = {g.longitude, g.latitude, g.height};
      odometer.samples.push_back({t, 0.8 * i});
      g = geodesy::wgs84.displaced(g, v);
    }
    EXPECT_TRUE(check_gnss_plausibility(nullptr, gnss, "gnss.csv")) << course;
    const auto by_velocity = check_gnss_plausibility(nullptr, swapped, "gnss.csv");
    ASSERT_FALSE(by_velocity) << course;
    EXPECT_NE(by_velocity.error().message().find("swapped"), std::string::npos);
    EXPECT_TRUE(check_gnss_way(gnss, odometer, "gnss.csv")) << course;
    // Nearly north the way changes by the cosine of a small longitude only.
    if (std::abs(std::sin(course)) > 0.5) {
      const auto by_way = check_gnss_way(swapped, odometer, "gnss.csv");
      ASSERT_FALSE(by_way) << course;
      EXPECT_NE(by_way.error().advice.find("swapped"), std::string::npos);
    }
  }
}

TEST(Plausibility, RecordingsMustOverlap) {
  const Extent imu{"imu", "imu.csv", TimeScale::gps, {0}, {1000}};
  const Extent other_day{"gnss", "gnss.csv", TimeScale::gps, {86'400'000'000'000}, {86'500'000'000'000}};
  const Extent other_scale{"gnss", "gnss.csv", TimeScale::recorder, {0}, {1000}};
  const Extent same{"gnss", "gnss.csv", TimeScale::gps, {500}, {5000}};
  const std::vector<Extent> good{imu, same}, day{imu, other_day}, scale{imu, other_scale};
  EXPECT_TRUE(check_overlap(good));
  ASSERT_FALSE(check_overlap(day));
  EXPECT_EQ(check_overlap(day).error().file, "gnss.csv");
  ASSERT_FALSE(check_overlap(scale));
  EXPECT_NE(check_overlap(scale).error().advice.find("gps_week"), std::string::npos);
}

}  // namespace
}  // namespace versine::sensors
