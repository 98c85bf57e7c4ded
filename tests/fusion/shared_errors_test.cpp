// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/shared_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <map>

#include "fusion/run.hpp"
#include "versine/filter/consistency.hpp"

namespace versine::fusion {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Points in pairs along a line; each landmark is measured from four pairs, the next from three of these and a new one.
constexpr int points_each = 8, new_points = 2;
constexpr double point_sigma = 5e-3;

/// Landmark k: a position is the mean of its points' errors, an attitude their difference from side to side and along.
std::vector<ErrorCause> causes_at(int k) {
  std::vector<ErrorCause> causes;
  for (int i = 0; i < points_each; ++i) {
    const double side = i % 2 == 0 ? -2.6 : 2.6, along = 60.0 * (i / 2) - 90.0;
    Eigen::Matrix<double, 6, 3> effect = Eigen::Matrix<double, 6, 3>::Zero();
    effect.topRows<3>() = point_sigma / points_each * Eigen::Matrix3d::Identity();
    effect(3, 2) = point_sigma / points_each / side;
    effect(4, 2) = point_sigma / points_each * along / 4500.0;
    effect(5, 1) = point_sigma / points_each * along / 4500.0;
    causes.push_back({"P" + std::to_string(new_points * k + i), effect});
  }
  return causes;
}

TEST(SharedErrors, KeepWhatTheCausesSay) {
  std::vector<std::vector<ErrorCause>> causes;
  for (int k = 0; k < 6; ++k) causes.push_back(causes_at(k));
  const auto shared = share_errors(causes, 6);
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const Matrix6 own = shared_covariance(causes[k], causes[k]);
    const Vector6 scale = own.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((scale.asDiagonal() * (shared[k]->root * shared[k]->root.transpose() - own) * scale.asDiagonal())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6);
    if (k == 0) continue;
    const Vector6 kept = (shared[k - 1]->place - shared[k]->place).array().exp();
    EXPECT_LE(kept.maxCoeff(), 1.0);
    // A point serves another pair's place at the next landmark: position keeps 6 of 8 points.
    const Matrix6 cross = shared[k]->root * kept.asDiagonal() * shared[k - 1]->root.transpose();
    const Matrix6 told = shared_covariance(causes[k], causes[k - 1]);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(cross(i, i) / told(i, i), 1.0, 0.05) << "row " << i;
    EXPECT_NEAR(cross(0, 0) / own(0, 0), 0.75, 0.02);
  }
}

TEST(SharedErrors, LandmarksWithoutCommonPointsAreIndependent) {
  const std::vector<std::vector<ErrorCause>> causes{causes_at(0), {}, causes_at(points_each)};
  const auto shared = share_errors(causes, 3);
  EXPECT_FALSE(shared[1]);
  EXPECT_LE((shared[0]->place - shared[2]->place).head<3>().array().exp().maxCoeff(), 1e-3 + 1e-12);
  EXPECT_EQ(shared[0]->root.bottomRows<3>().norm(), 0.0);
}

/// The same points at every landmark: their error is constant, and no number of landmarks makes it smaller.
TEST(SharedErrors, WhatAllShareDoesNotAverageAway) {
  const std::vector<std::vector<ErrorCause>> causes(5, causes_at(0));
  const auto shared = share_errors(causes, 3);
  EXPECT_LT(shared[4]->place.maxCoeff(), 1e-4);
}

// --- in the aided INS

constexpr double own_sigma = 1e-3, own_angle = 1e-4, spacing = 1.5;

/// A ride whose position and attitude come from landmarks alone, with errors drawn point by point.
struct Ride {
  test::Scenario scenario{
      .motion = {.speed = 8.0, .swing = 3.0, .turn = 0.8, .climb = 0.02, .roll = 0.03, .period = 20.0, .still = 6.0},
      .duration = 24.0,
      .rate = 100.0};
  test::Simulated run;

  Ride(unsigned seed, bool attitude, bool told) {
    run = test::make(scenario, seed);
    run.input.gnss = {};
    run.options.gate_probability = 1e-12;
    run.options.zero_velocity = false;
    std::mt19937_64 random(seed + 77);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
    std::map<std::string, Eigen::Vector3d> drawn;
    std::vector<std::vector<ErrorCause>> causes;
    for (int k = 0; 0.5 + spacing * k < scenario.duration - 0.5; ++k) {
      causes.push_back(causes_at(k));
      Vector6 error = Vector6::Zero();
      for (const ErrorCause& c : causes.back()) {
        error += c.effect * drawn.try_emplace(c.name, vector()).first->second;
      }
      error.head<3>() += own_sigma * vector();
      error.tail<3>() += own_angle * vector();
      const auto truth = test::truth_at(scenario, run.truth, 0.5 + spacing * k);
      sensors::LandmarkSample l{.time = truth.time, .from = truth.time, .to = truth.time};
      l.position = geodesy::wgs84.displaced(truth.position, error.head<3>());
      const Matrix6 whole = shared_covariance(causes.back(), causes.back());
      l.covariance = whole.topLeftCorner<3, 3>() + own_sigma * own_sigma * Eigen::Matrix3d::Identity();
      if (attitude) {
        l.q_ns = geodesy::from_rotation_vector(-error.tail<3>()) * truth.q_nb;
        l.attitude_covariance = whole.bottomRightCorner<3, 3>() + own_angle * own_angle * Eigen::Matrix3d::Identity();
        l.position_attitude = whole.topRightCorner<3, 3>();
      }
      run.input.landmarks.samples.push_back(l);
    }
    if (!told) return;
    const auto shared = share_errors(causes, attitude ? 6 : 3);
    for (std::size_t k = 0; k < shared.size(); ++k) run.input.landmarks.samples[k].shared = shared[k];
  }
};

test::Nees mean_nees(bool attitude, bool told, int runs) {
  test::Nees sum;
  for (int i = 0; i < runs; ++i) {
    const Ride ride(400u + unsigned(i), attitude, told);
    sum += test::nees(ride.scenario, ride.run, test::solve(ride.run).solution.smoothed[1500]);
  }
  return {sum.position / (3 * runs), sum.velocity / (3 * runs), sum.attitude / (3 * runs)};
}

TEST(SharedErrors, FilterKnowsHowLittleSharedPointsTell) {
  const int runs = 80;
  const filter::Bounds b = filter::mean_chi_square_bounds(std::size_t(runs), 3.0, 0.99);
  const test::Nees positions = mean_nees(false, true, runs), poses = mean_nees(true, true, runs);
  std::printf("NEES/3, positions: %.3f, %.3f; positions and attitudes: %.3f, %.3f\n", positions.position,
              positions.attitude, poses.position, poses.attitude);
  for (const double x : {positions.position, positions.attitude, poses.position, poses.attitude}) {
    EXPECT_GT(x, b.lower);
    EXPECT_LT(x, b.upper);
  }
  // Taken as independent they tell too much: the test can fail.
  EXPECT_GT(mean_nees(true, false, 30).position, b.upper);
}

}  // namespace
}  // namespace versine::fusion
