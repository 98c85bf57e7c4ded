// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/linear_chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace versine::filter {
namespace {

constexpr int N = 3, M = 2;
using Step = LinearStep<N, M>;

/// A chain of random steps, some with observations, with the truth drawn from the model.
struct Sample {
  Estimate<N> initial;
  std::vector<Step> steps;
  std::vector<Eigen::Vector3d> truth;
};

Sample draw(unsigned seed, std::size_t epochs) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  const auto matrix = [&]<int R, int C>(Eigen::Matrix<double, R, C>) {
    return Eigen::Matrix<double, R, C>(Eigen::Matrix<double, R, C>::NullaryExpr([&] { return normal(engine); }));
  };
  Sample s;
  const Eigen::Matrix3d P = matrix(Eigen::Matrix3d());
  s.initial.covariance = P * P.transpose() + Eigen::Matrix3d::Identity();
  s.initial.mean = matrix(Eigen::Vector3d());
  Eigen::Vector3d x = s.initial.mean + s.initial.covariance.llt().matrixL() * matrix(Eigen::Vector3d());
  for (std::size_t k = 0; k < epochs; ++k) {
    Step step;
    step.transition = Eigen::Matrix3d::Identity() + 0.2 * matrix(Eigen::Matrix3d());
    const Eigen::Vector3d g = 0.3 * matrix(Eigen::Vector3d());
    step.noise = g * g.transpose();  // of rank one, as a single noise gives
    x = step.transition * x + g * normal(engine);
    if (k % 4 == 2) {
      LinearObservation<N, M> o;
      o.H = matrix(Eigen::Matrix<double, M, N>());
      o.R = Eigen::Vector2d(0.04, 0.09).asDiagonal();
      o.z = o.H * x + Eigen::Vector2d(0.2 * normal(engine), 0.3 * normal(engine));
      step.observation = o;
    }
    s.truth.push_back(x);
    s.steps.push_back(step);
  }
  return s;
}

/// The joint distribution of all epochs at once, by dense conditioning: no recursion in it.
struct Batch {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
Batch batch(const Sample& s) {
  const auto n = static_cast<Eigen::Index>(s.steps.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(N * n, N * n);
  Eigen::VectorXd m(N * n);
  Eigen::Matrix3d P = s.initial.covariance;
  Eigen::Vector3d x = s.initial.mean;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& F = s.steps[size_t(k)].transition;
    if (k > 0) {
      C.block(N * k, 0, N, N * k) = F * C.block(N * (k - 1), 0, N, N * k);
      C.block(0, N * k, N * k, N) = C.block(N * k, 0, N, N * k).transpose();
    }
    P = F * P * F.transpose() + s.steps[size_t(k)].noise;
    x = F * x;
    C.block<N, N>(N * k, N * k) = P;
    m.segment<N>(N * k) = x;
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!s.steps[size_t(k)].observation) continue;
    const auto& o = *s.steps[size_t(k)].observation;
    const Eigen::MatrixXd CHt = C.middleCols(N * k, N) * o.H.transpose();
    const Eigen::Matrix2d S = o.H * CHt.middleRows(N * k, N) + o.R;
    const Eigen::MatrixXd K = CHt * S.inverse();
    m += K * (o.z - o.H * m.segment<N>(N * k));
    C -= K * CHt.transpose();
  }
  return {m, C};
}

TEST(LinearChain, BothSmoothersEqualBatchAndEachOther) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Sample s = draw(seed, 24);
    const std::span<const Step> steps(s.steps);
    const auto forward = filter_forward(s.initial, steps);
    const std::span<const ForwardEpoch<N, M>> f(forward);
    const auto rts = smooth_rts(steps, f), two = smooth_two_filter(steps, f);
    const Batch b = batch(s);
    for (std::size_t k = 0; k < s.steps.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(N * k);
      const Eigen::Matrix3d P = b.covariance.block<N, N>(at, at);
      const double scale = P.norm();
      EXPECT_LT((rts[k].estimate.covariance - two[k].estimate.covariance).norm(), 1e-9 * scale);
      EXPECT_LT((rts[k].estimate.mean - two[k].estimate.mean).norm(), 1e-9 * (1 + two[k].estimate.mean.norm()));
      EXPECT_LT((rts[k].estimate.covariance - P).norm(), 1e-8 * scale);
      EXPECT_LT((rts[k].estimate.mean - b.mean.segment<N>(at)).norm(), 1e-8);
      EXPECT_GE((forward[k].updated.covariance - rts[k].estimate.covariance).eigenvalues().real().minCoeff(), -1e-10);
      if (k + 1 < s.steps.size()) {  // the gain gives what neighbours share
        const Eigen::Matrix3d cross = rts[k].gain * rts[k + 1].estimate.covariance;
        EXPECT_LT((cross - b.covariance.block<N, N>(at, at + N)).norm(), 1e-8 * scale);
        EXPECT_EQ(rts[k].gain, two[k].gain);
      }
    }
  }
}

TEST(LinearChain, NormalisedErrorIsChiSquare) {
  double sum = 0.0;
  constexpr int runs = 2000;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const Sample s = draw(seed, 10);
    const std::span<const Step> steps(s.steps);
    const auto forward = filter_forward(s.initial, steps);
    const auto rts = smooth_rts(steps, std::span<const ForwardEpoch<N, M>>(forward));
    const Eigen::Vector3d e = rts[5].estimate.mean - s.truth[5];
    sum += e.dot(rts[5].estimate.covariance.ldlt().solve(e));
  }
  EXPECT_NEAR(sum / runs, 3.0, 3.0 * std::sqrt(6.0 / runs));  // three standard errors
}

}  // namespace
}  // namespace versine::filter
