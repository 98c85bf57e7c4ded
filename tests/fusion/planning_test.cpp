// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "versine/core/units.hpp"
#include "versine/fusion/landmark_model.hpp"

namespace versine::fusion {
namespace {

using namespace units;

// Jiang 2017 eq. 46.
constexpr double T = 60.0, v = 1.0, sigma_r = 0.6 * mm;
constexpr CrossErrors eq46_vertical{sigma_r, sigma_r, 0.005 * deg, 0.05 * deg_per_hour, 0.02 * deg_per_sqrt_hour};
constexpr CrossErrors eq46_lateral{sigma_r, sigma_r, 0.2 * deg, 0.05 * deg_per_hour, 0.02 * deg_per_sqrt_hour};
constexpr LongitudinalErrors eq46_longitudinal{sigma_r, sigma_r, 0.002, 0.000008};

double sigma_mm(double variance) {
  return std::sqrt(variance) / mm;
}

TEST(Planning, CheckValuesOfEquation46ToFiveDigits) {
  const double expected[][2] = {{0, 0.59648}, {10, 0.55712}, {30, 0.57960}, {45, 0.55606}, {60, 0.59648}};
  for (const auto& [t, sigma] : expected) {
    EXPECT_NEAR(sigma_mm(cross_variance(eq46_vertical, v, T, t)), sigma, 0.5e-5) << t;
  }
}

/// Conditional variance of a random vector given one observation of another of its elements, from the joint
/// covariance at t and T: the exact truth for one interval, with no filter in it.
double conditional_variance(double p, double s, double rt, double rT, double rtT) {
  return p + rt - (p + rtT) * (p + rtT) / (p + rT + s);
}

TEST(Planning, ClosedFormsAreTheExactConditionalVariance) {
  for (const CrossErrors& e : {eq46_vertical, eq46_lateral, CrossErrors{2e-3, 1e-3, 1e-3, 1e-6, 1e-5}}) {
    const double q = e.random_walk * e.random_walk, a = e.angle * e.angle, w = e.bias * e.bias;
    // r(t) = r0 + phi0 v t - w v t^2/2 + v W(t), W the integrated Brownian motion of density q.
    const auto cross = [&](double t, double u) {  // t <= u
      return v * v * (a * t * u + w * t * t * u * u / 4 + q * t * t * (3 * u - t) / 6);
    };
    for (double t = 0; t <= T; t += 2.5) {
      const double exact = conditional_variance(e.start_position * e.start_position, e.landmark * e.landmark,
                                                cross(t, t), cross(T, T), cross(t, T));
      EXPECT_NEAR(cross_variance(e, v, T, t), exact, 1e-9 * exact) << t;
    }
  }
  const auto& e = eq46_longitudinal;
  const auto cross = [&](double t, double u) {
    return v * v * (e.scale * e.scale * t * u + e.scale_walk * e.scale_walk * t * t * (3 * u - t) / 6);
  };
  for (double t = 0; t <= T; t += 2.5) {
    const double exact =
        conditional_variance(sigma_r * sigma_r, sigma_r * sigma_r, cross(t, t), cross(T, T), cross(t, T));
    EXPECT_NEAR(longitudinal_variance(e, v, T, t), exact, 1e-9 * exact) << t;
  }
}

/// Figure 5: closed form, RTS and two-filter smoother, along one interval.
TEST(Planning, Figure5ThreeCurvesIdentical) {
  const double heading = 0.7, dt = 0.5;
  const landmark::DrivingNoise noise{.random_walk = eq46_vertical.random_walk,
                                     .scale_walk = eq46_longitudinal.scale_walk};
  const landmark::Motion motion = landmark::Motion::straight(dt, v, heading);
  std::vector<landmark::VerticalStep> vertical(1);
  std::vector<landmark::LevelStep> level(1);
  for (double t = dt; t <= T; t += dt) {
    vertical.push_back(landmark::vertical_step(motion, noise));
    level.push_back(landmark::level_step(motion, noise));
  }
  vertical.back().observation = landmark::observe_down(0.0, sigma_r * sigma_r);
  level.back().observation =
      landmark::observe_level(Eigen::Vector2d::Zero(), sigma_r * sigma_r * Eigen::Matrix2d::Identity());
  landmark::VerticalEstimate v0;
  v0.covariance.diagonal() << sigma_r, eq46_vertical.angle, eq46_vertical.bias;
  v0.covariance.diagonal() = v0.covariance.diagonal().cwiseAbs2().eval();
  landmark::LevelEstimate l0;
  l0.covariance.diagonal() << sigma_r, sigma_r, eq46_longitudinal.scale, eq46_lateral.angle, eq46_lateral.bias;
  l0.covariance.diagonal() = l0.covariance.diagonal().cwiseAbs2().eval();

  const std::span<const landmark::VerticalStep> vs(vertical);
  const std::span<const landmark::LevelStep> ls(level);
  const auto vf = filter::filter_forward(v0, vs);
  const auto lf = filter::filter_forward(l0, ls);
  using VerticalForward = std::span<const filter::ForwardEpoch<3, 1>>;
  using LevelForward = std::span<const filter::ForwardEpoch<5, 2>>;
  const auto v_rts = filter::smooth_rts(vs, VerticalForward(vf)),
             v_tfs = filter::smooth_two_filter(vs, VerticalForward(vf));
  const auto l_rts = filter::smooth_rts(ls, LevelForward(lf)), l_tfs = filter::smooth_two_filter(ls, LevelForward(lf));
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), aside(-along.y(), along.x());
  double largest = 0.0;
  for (std::size_t k = 0; k < vertical.size(); ++k) {
    const double t = dt * double(k);
    const double vertical_closed = std::sqrt(cross_variance(eq46_vertical, v, T, t));
    const double lateral_closed = std::sqrt(cross_variance(eq46_lateral, v, T, t));
    const double along_closed = std::sqrt(longitudinal_variance(eq46_longitudinal, v, T, t));
    for (const auto* smoothed : {&v_rts, &v_tfs}) {
      largest = std::max(largest, std::abs(std::sqrt((*smoothed)[k].estimate.covariance(0, 0)) - vertical_closed));
    }
    for (const auto* smoothed : {&l_rts, &l_tfs}) {
      const Eigen::Matrix2d P = (*smoothed)[k].estimate.covariance.topLeftCorner<2, 2>();
      largest = std::max(largest, std::abs(std::sqrt(aside.dot(P * aside)) - lateral_closed));
      largest = std::max(largest, std::abs(std::sqrt(along.dot(P * along)) - along_closed));
    }
  }
  RecordProperty("largest_difference_m", std::to_string(largest));
  EXPECT_LT(largest, 1e-9);
}

TEST(Planning, Section5GyrocompassAndEquivalentBias) {
  // 0.03 deg/h gives 0.18 deg and 0.1 deg/h gives 0.6 deg at 50 degrees of latitude.
  EXPECT_NEAR(gyrocompass_heading_error(0.03 * deg_per_hour, 50 * deg) / deg, 0.178, 0.001);
  EXPECT_NEAR(gyrocompass_heading_error(0.1 * deg_per_hour, 50 * deg) / deg, 0.593, 0.001);
  const auto b = equivalent_bias(0.03 * deg_per_hour, 0.003 * deg, 0.178 * deg, 50 * deg, 0.0);
  EXPECT_NEAR(b.lateral / deg_per_hour, 0.0424, 0.0005);
  EXPECT_NEAR(b.lateral_worst / deg_per_hour, 0.0606, 0.0005);
  EXPECT_NEAR(b.returns_with_turn / deg_per_hour, 0.03, 0.0005);
}

}  // namespace
}  // namespace versine::fusion
