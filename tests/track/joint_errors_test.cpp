// SPDX-License-Identifier: Apache-2.0
#include "versine/track/joint_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <random>

#include "versine/geodesy/ellipsoid.hpp"
#include "versine/track/correlated_errors.hpp"

namespace versine::track {
namespace {

/// A chain from a random stable system by the smoother's own formulas, so that it is a valid joint distribution.
filter::ErrorChain chain_of(int epochs, int dim, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> g;
  filter::ErrorChain chain;
  std::vector<Eigen::MatrixXf> A;
  for (int k = 0; k + 1 < epochs; ++k) {
    Eigen::MatrixXf a = Eigen::MatrixXf::Identity(dim, dim);
    for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] += 0.05f * g(random);
    A.push_back(0.95f * a);
  }
  std::vector<Eigen::MatrixXf> P(epochs, Eigen::MatrixXf::Identity(dim, dim));
  for (int k = epochs - 2; k >= 0; --k) {
    P[k] = A[k] * P[k + 1] * A[k].transpose() + 0.1f * Eigen::MatrixXf::Identity(dim, dim);
  }
  for (int k = 0; k < epochs; ++k) {
    chain.push_back(Time{k * 1'000'000'000LL}, P[k], k + 1 < epochs ? A[k] : Eigen::MatrixXf());
  }
  return chain;
}

void compare(bool reversed) {
  const auto chain = chain_of(60, 9, 3);
  std::vector<Time> times;
  std::vector<std::size_t> epoch;
  for (int k = 0; k < 30; ++k) {
    epoch.push_back(static_cast<std::size_t>(2 * k));
    times.push_back(chain.time(epoch.back()));
  }
  if (reversed) {
    std::reverse(times.begin(), times.end());
    std::reverse(epoch.begin(), epoch.end());
  }
  std::vector<ErrorRow> rows;
  std::mt19937 random(5);
  std::normal_distribution<float> g;
  for (int k = 0; k < 30; ++k) rows.push_back(ErrorRow::NullaryExpr([&] { return g(random); }));
  JointErrors joint(chain, times);
  const std::vector<JointErrors::Term> terms = {{-4, -0.5}, {0, 1.0}, {4, -0.5}};
  const auto v = joint.variance(terms, rows);
  for (int i = 4; i + 4 < 30; ++i) {
    double expected = 0;
    for (const auto& a : terms) {
      for (const auto& b : terms) {
        const auto p = static_cast<std::size_t>(i + a.node), q = static_cast<std::size_t>(i + b.node);
        expected += a.weight * b.weight *
                    rows[p].cast<double>().dot(chain.cross_covariance(epoch[p], epoch[q]) * rows[q].cast<double>());
      }
    }
    EXPECT_NEAR(v[static_cast<std::size_t>(i)], expected, 1e-4 * (1 + expected)) << i;
  }
  EXPECT_TRUE(std::isnan(v[3]));
  EXPECT_TRUE(std::isnan(v[26]));

  // A filter over the same nodes, every third of them, for two kinds of rows at once.
  const std::vector<float> weights = {-0.3f, -0.1f, 0.2f, 0.9f, 0.2f, -0.1f, -0.3f};
  const std::vector<ErrorRow> doubled = [&] {
    std::vector<ErrorRow> d = rows;
    for (ErrorRow& r : d) r *= 2.0f;
    return d;
  }();
  const std::array<std::span<const ErrorRow>, 2> kinds = {rows, doubled};
  const auto f = joint.filtered_variance(weights, kinds, 3);
  for (std::size_t i = 3; i + 3 < 30; i += 3) {
    std::vector<JointErrors::Term> same;
    for (int k = -3; k <= 3; ++k) same.push_back({k, weights[static_cast<std::size_t>(k + 3)]});
    const double expected = joint.variance(same, rows)[i];
    EXPECT_NEAR(f[0][i], expected, 1e-4 * (1 + expected)) << i;
    EXPECT_NEAR(f[1][i], 4 * expected, 4e-4 * (1 + expected)) << i;
    EXPECT_TRUE(std::isnan(f[0][i + 1]));
  }
  EXPECT_TRUE(std::isnan(f[0][0]));
}

TEST(JointErrors, VarianceEqualsTheDirectSum) {
  compare(false);
}
TEST(JointErrors, VarianceEqualsTheDirectSumWhenTheRunGoesDown) {
  compare(true);
}

TEST(JointErrors, ACommonErrorCancelsInAVersine) {
  filter::ErrorChain chain;
  const Eigen::MatrixXf I = Eigen::MatrixXf::Identity(6, 6);
  std::vector<Time> times;
  for (int k = 0; k < 20; ++k) {
    chain.push_back(Time{k * 1'000'000'000LL}, I, k < 19 ? I : Eigen::MatrixXf());
    times.push_back(chain.time(static_cast<std::size_t>(k)));
  }
  const std::vector<ErrorRow> rows(20, ErrorRow::Unit(0));
  JointErrors joint(chain, times);
  const std::vector<JointErrors::Term> versine = {{-2, -0.5}, {0, 1.0}, {2, -0.5}}, point = {{0, 1.0}};
  EXPECT_NEAR(joint.variance(versine, rows)[10], 0.0, 1e-6);
  EXPECT_NEAR(joint.variance(point, rows)[10], 1.0, 1e-6);
}

/// Sigmas alone, and the way over which errors change: a difference over d has 2 (1 - exp(-d / length)) of a variance.
TEST(JointErrors, OfATrajectoryThatComesWithSigmasOnly) {
  geodesy::Trajectory t;
  const double metre = 1.0 / geodesy::wgs84.meridian_radius(0.9);
  for (int k = 0; k <= 400; ++k) {
    geodesy::TrajectoryPoint p;
    p.time = Time{k * 1'000'000'000LL};
    p.position = {0.9 + 0.5 * k * metre, 0.2, 0.0};
    p.position_covariance = {9e-6f, 4e-6f, 1e-6f};
    p.attitude_covariance = {1e-8f, 1e-8f, 1e-8f};
    t.samples.push_back(p);
  }
  const auto chain = correlated_errors(t, 100.0);
  std::vector<Time> times;
  for (int k = 0; k < 20; ++k) times.push_back(Time{k * 20'000'000'000LL});  // every 10 m
  JointErrors joint(chain, times);
  const std::vector<ErrorRow> rows(20, ErrorRow::Unit(0));
  const std::vector<JointErrors::Term> point = {{0, 1.0}}, difference = {{0, -1.0}, {2, 1.0}};
  EXPECT_NEAR(joint.variance(point, rows)[5], 9e-6, 1e-9);
  EXPECT_NEAR(joint.variance(difference, rows)[5], 2.0 * 9e-6 * (1.0 - std::exp(-0.2)), 2e-8);
}

}  // namespace
}  // namespace versine::track
