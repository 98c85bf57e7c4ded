// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_dead_reckoning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "versine/core/units.hpp"
#include "versine/fusion/planning.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/straight_run.hpp"

namespace versine::fusion {
namespace {

using namespace units;
using simulation::StraightRecording;
using simulation::StraightRun;
using ::testing::HasSubstr;

const sensors::TriadErrors rlg{.bias = 0.03 * deg_per_hour, .random_walk = 0.005 * deg_per_sqrt_hour};

LandmarkInput input_of(const StraightRecording& r) {
  return {&r.imu, &r.odometer, &r.landmarks};
}

/// Jiang's procedure: 15 minutes of standing, then 1 m/s with a landmark every 60 m.
StraightRun survey(std::vector<double> spacing, double landmark = 0.6 * mm) {
  return {.latitude = 50 * deg,
          .heading = 0.8,
          .speed = 1.0,
          .spacing = std::move(spacing),
          .stand_first = 905.0,
          .stand = 10.0,
          .rate = 100.0,
          .gyro = rlg,
          .accelerometer = {.bias = 50 * mGal},
          .scale = 0.001,
          .scale_walk = 8e-6,
          .landmark = landmark};
}
LandmarkOptions options() {
  LandmarkOptions o;
  o.gyro = rlg;
  return o;
}

/// Errors along, to the right and down, m, at every sample of the solution.
std::vector<Eigen::Vector3d> errors(const LandmarkSolution& s, const StraightRecording& r) {
  std::vector<Eigen::Vector3d> e;
  const std::size_t first = r.imu.size() - s.solution.smoothed.size();
  const double c = std::cos(r.attitude.yaw), sn = std::sin(r.attitude.yaw);
  for (std::size_t i = first; i < r.imu.size(); ++i) {
    const Eigen::Vector3d d = geodesy::wgs84.ned_difference(r.truth[i], s.solution.smoothed[i - first].position);
    e.emplace_back(c * d.x() + sn * d.y(), -sn * d.x() + c * d.y(), d.z());
  }
  return e;
}

Expected<LandmarkSolution> run(const StraightRecording& r, const LandmarkOptions& o = options()) {
  SilentProgress silent;
  return run_landmark_dead_reckoning(input_of(r), o, silent);
}

TEST(LandmarkDeadReckoning, ErrorFreeRecordingReturnsTheTruth) {
  StraightRun perfect = survey({60, 60, 60}, 1e-6);
  perfect.gyro = {};
  perfect.accelerometer = {};
  perfect.scale = perfect.scale_walk = 0.0;
  const auto r = simulate_straight(perfect, 1);
  const auto s = run(r);
  ASSERT_TRUE(s) << s.error().message();
  double worst = 0.0;
  for (const auto& e : errors(*s, r)) worst = std::max(worst, e.norm());
  EXPECT_LT(worst, 1e-5);
  const auto attitude = geodesy::to_euler(s->solution.smoothed.back().q_nb);
  EXPECT_NEAR(attitude.yaw, r.attitude.yaw, 1e-6);
  EXPECT_NEAR(attitude.pitch, 0.0, 1e-6);
  EXPECT_EQ(s->observability.vertical_rank, 3);
  EXPECT_EQ(s->observability.level_rank, 5);
  EXPECT_EQ(s->observability.run_level_rank, 5);
}

TEST(LandmarkDeadReckoning, ErrorsAgreeWithTheirSigmas) {
  // Every 10 m of five intervals, over 160 seeds: coverage of the 95 % interval and normalised errors.
  double inside = 0.0, count = 0.0, nees = 0.0, epochs = 0.0;
  for (std::uint64_t seed = 1; seed <= 160; ++seed) {
    auto course = survey({60, 60, 45, 80, 60});
    course.stand_first = 120.0;
    const auto r = simulate_straight(course, seed);
    const auto s = run(r);
    ASSERT_TRUE(s) << s.error().message();
    const auto e = errors(*s, r);
    for (std::size_t i = 500; i < e.size(); i += 1000) {
      const Eigen::Matrix3d P = s->solution.smoothed[i].position_covariance.matrix();
      const double c = std::cos(0.8), sn = std::sin(0.8);
      Eigen::Matrix3d R;
      R << c, sn, 0, -sn, c, 0, 0, 0, 1;
      const Eigen::Matrix3d Q = R * P * R.transpose();
      for (int k = 0; k < 3; ++k) inside += std::abs(e[i][k]) < 1.96 * std::sqrt(Q(k, k)) ? 1 : 0;
      count += 3;
      nees += e[i].dot(Q.llt().solve(e[i]));
      ++epochs;
    }
  }
  EXPECT_NEAR(inside / count, 0.95, 0.02);
  EXPECT_NEAR(nees / epochs, 3.0, 0.25);
}

TEST(LandmarkDeadReckoning, SmoothersAgree) {
  const auto r = simulate_straight(survey({60, 60}), 5);
  auto o = options();
  const auto a = run(r, o);
  o.smoother = LandmarkSmoother::two_filter;
  const auto b = run(r, o);
  ASSERT_TRUE(a && b);
  double worst = 0.0, sigma = 0.0;
  for (std::size_t i = 0; i < a->solution.smoothed.size(); ++i) {
    const auto &p = a->solution.smoothed[i], &q = b->solution.smoothed[i];
    worst = std::max(worst, geodesy::wgs84.ned_difference(p.position, q.position).norm());
    sigma = std::max(sigma, std::abs(double(p.position_covariance.zz) / q.position_covariance.zz - 1.0));
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_LT(sigma, 1e-5);  // stored as float
}

TEST(LandmarkDeadReckoning, OutlierIsFoundAndMissedLandmarkBridged) {
  auto r = simulate_straight(survey({60, 60, 60, 60, 60}), 3);
  const auto clean = run(r);
  r.landmarks.samples[2].position = geodesy::wgs84.displaced(r.landmarks[2].position, {0.01, -0.005, 0.0});
  const auto dirty = run(r);
  r.landmarks.samples.erase(r.landmarks.samples.begin() + 2);
  const auto missed = run(r);
  ASSERT_TRUE(clean && dirty && missed);
  EXPECT_TRUE(clean->solution.record.rejections.empty());
  ASSERT_EQ(dirty->solution.record.rejections.size(), 1u);
  EXPECT_FALSE(dirty->landmarks[2].fit.used);
  EXPECT_GT(dirty->solution.record.rejections[0].normalized, 4.0);
  double worst = 0.0;
  for (std::size_t i = 0; i < dirty->solution.smoothed.size(); ++i) {
    worst = std::max(
        worst,
        geodesy::wgs84.ned_difference(dirty->solution.smoothed[i].position, missed->solution.smoothed[i].position)
            .norm());
  }
  EXPECT_LT(worst, 2e-5);
}

TEST(LandmarkDeadReckoning, OutputRateThinsTheTrajectoryAndChangesNothingElse) {
  const auto r = simulate_straight(survey({60, 60}), 5);
  auto o = options();
  const auto all = run(r, o);
  o.output_rate = 10.0;
  const auto thin = run(r, o);
  ASSERT_TRUE(all && thin);
  ASSERT_NEAR(double(thin->solution.smoothed.size()), double(all->solution.smoothed.size()) / 10.0, 1.0);
  const auto& p = thin->solution.smoothed[300];
  const auto& q = all->solution.smoothed[3000];
  EXPECT_EQ(p.time, q.time);
  EXPECT_EQ(p.position, q.position);
}

TEST(LandmarkDeadReckoning, TurningTrackKeepsItsPromise) {
  // R = 150 m with cant, landmark every 60 m, rough track, by the general simulator: the model's own error is small and
  // the sigmas cover the errors; a quarter circle between landmarks draws a warning.
  simulation::Scenario s;
  s.track.alignment.crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
  s.track.height = 400.0;
  const double straight = std::numeric_limits<double>::infinity();
  s.track.alignment.horizontal = *design::HorizontalAxis::chain(
      {500000.0, 5250000.0, 0.5},
      {design::line(150.0), design::transition(design::Shape::clothoid, 80.0, straight, 150.0),
       design::arc(200.0, 150.0), design::transition(design::Shape::clothoid, 80.0, 150.0, straight),
       design::line(200.0)});
  s.track.alignment.cant = *design::CantProfile::from_points(
      {{.distance = 150.0}, {.distance = 230.0, .cant = 0.15}, {.distance = 430.0, .cant = 0.15}, {.distance = 510.0}});
  s.track.spectrum = simulation::Spectrum::german_low;
  s.motion.start = 20.0;
  s.motion.stand = 400.0;
  simulation::ImuModel imu;
  imu.rate = 100.0;
  imu.errors = sensors::find_imu_grade("rlg-jiang")->errors;
  s.equipment.imu = imu;
  s.equipment.odometers.push_back({.quantum = 0.1 * mm, .scale = 1e-3});
  auto o = options();
  o.gyro = imu.errors.gyro;
  o.lever_odometer = {0.0, s.trolley.reference_y, s.trolley.contact_z};
  o.odometer_resolution = 0.1 * mm;
  o.path_walk = 0.02 * mm;
  o.mounting_sigma = 0.05e-3;
  for (const double spacing : {60.0, 240.0}) {
    s.equipment.total_station = simulation::TotalStationModel{.every = spacing};
    o.lever_landmark = s.equipment.total_station->place;
    s.motion.legs = {{.to = 680.0, .speed = 1.0, .stop = 20.0, .stop_every = spacing, .stop_each = 20.0}};
    const auto r = simulation::simulate(s, 3);
    ASSERT_TRUE(r) << r.error().message();
    Series<sensors::LandmarkSample> landmarks;
    landmarks.samples = r->landmarks;
    SilentProgress silent;
    const auto solved = run_landmark_dead_reckoning({&r->imu, &r->odometers[0], &landmarks}, o, silent);
    ASSERT_TRUE(solved) << solved.error().message();
    const bool warned = std::any_of(
        solved->solution.record.warnings.begin(), solved->solution.record.warnings.end(), [](const auto& w) {
          return w.find("reduced model") != std::string::npos && w.find("m from the start, with") != std::string::npos;
        });
    EXPECT_EQ(warned, spacing > 100.0);
    EXPECT_TRUE(solved->solution.record.rejections.empty());
    double squares = 0.0, normalised = 0.0, count = 0.0;
    for (std::size_t i = 0; i < r->truth.trajectory.size(); i += 20) {
      const auto& truth = r->truth.trajectory[i];
      const std::size_t k = solved->solution.smoothed.lower_bound(truth.time);
      if (k == 0 || k >= solved->solution.smoothed.size() || r->truth.progress[i].speed == 0.0) continue;
      const auto &a = solved->solution.smoothed[k - 1], &b = solved->solution.smoothed[k];
      const double u = (truth.time - a.time).seconds() / (b.time - a.time).seconds();
      const Eigen::Vector3d e = (1 - u) * geodesy::wgs84.ned_difference(truth.position, a.position) +
                                u * geodesy::wgs84.ned_difference(truth.position, b.position);
      squares += e.squaredNorm();
      normalised += e.dot(a.position_covariance.matrix().llt().solve(e));
      ++count;
    }
    if (spacing < 100.0) {
      EXPECT_LT(std::sqrt(squares / count / 3.0), 0.7 * mm);
    }
    EXPECT_LT(normalised / count, 8.0);  // one run: neighbouring errors are alike
  }
}

TEST(LandmarkDeadReckoning, ErrorChainSharesWhatNeighboursShare) {
  const auto r = simulate_straight(survey({60, 60}), 5);
  const auto s = run(r);
  ASSERT_TRUE(s);
  const auto& chain = s->solution.chain;
  ASSERT_GT(chain.size(), 100u);
  const std::size_t i = chain.size() / 2;
  // The covariance of the difference between close epochs is far below twice the variance.
  const Eigen::Matrix<double, 6, 6> P = chain.covariance(i).topLeftCorner<6, 6>().cast<double>();
  const Eigen::Matrix<double, 6, 6> Q = chain.covariance(i + 1).topLeftCorner<6, 6>().cast<double>();
  const Eigen::Matrix<double, 6, 6> X = chain.cross_covariance(i, i + 1);
  for (int k : {0, 1, 2}) EXPECT_LT(P(k, k) + Q(k, k) - 2 * X(k, k), 0.01 * P(k, k)) << k;
  EXPECT_NEAR(P(2, 2), s->solution.smoothed[s->solution.smoothed.size() / 2].position_covariance.zz, 0.1 * P(2, 2));
}

TEST(LandmarkDeadReckoning, BadInputIsNamedWithItsCure) {
  auto r = simulate_straight(survey({60, 60}), 1);
  const auto message = [](const auto& result) { return result ? std::string("no error") : result.error().message(); };

  auto one = r;
  one.landmarks.samples.resize(1);
  EXPECT_THAT(message(run(one)), HasSubstr("at least two positions"));

  auto moving = r;
  moving.landmarks.samples[1].time = moving.landmarks.samples[1].time - Duration::from_seconds(20);
  moving.landmarks.samples[1].from = moving.landmarks.samples[1].to = moving.landmarks.samples[1].time;
  EXPECT_THAT(message(run(moving)), HasSubstr("while the odometer moved"));
  auto skip = options();
  skip.skip_moving_landmarks = true;
  const auto skipped = run(moving, skip);
  ASSERT_TRUE(skipped);
  EXPECT_EQ(skipped->solution.record.rejections.at(0).reason, "not standing");

  auto hurried = survey({60, 60});
  hurried.stand_first = 5.0;
  EXPECT_THAT(message(run(simulate_straight(hurried, 1))), HasSubstr("let the trolley stand at the start"));

  auto wheelless = r;
  wheelless.odometer.samples.clear();
  EXPECT_THAT(message(run(wheelless)), HasSubstr("needs an odometer"));

  auto gap = r;
  gap.imu.samples.erase(gap.imu.samples.begin() + 93000, gap.imu.samples.begin() + 93200);
  EXPECT_THAT(message(run(gap)), HasSubstr("a gap of 2.010 s"));

  auto nan = r;
  nan.imu.samples[93000].dtheta.x() = std::nan("");
  EXPECT_THAT(message(run(nan)), HasSubstr("not a number"));

  auto frame = r;
  for (std::size_t i = 1; i < frame.landmarks.size(); ++i)
    frame.landmarks.samples[i].position.height += 3.0 * double(i * i);
  EXPECT_THAT(message(run(frame)), HasSubstr("fit each other"));

  auto elsewhere = r;
  for (auto& l : elsewhere.landmarks.samples) l.time = l.from = l.to = l.time + Duration::from_seconds(86400);
  EXPECT_THAT(message(run(elsewhere)), HasSubstr("check the landmarks' clock"));
}

}  // namespace
}  // namespace versine::fusion
