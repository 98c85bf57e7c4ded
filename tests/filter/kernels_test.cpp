// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "versine/filter/consistency.hpp"
#include "versine/filter/state_blocks.hpp"

namespace versine::filter {
namespace {
constexpr int n = 25;  // a layout with and one without the wheels' ways has this size
using Vector = StateVector<n>;
using Matrix = StateMatrix<n>;

template <int M>
Transition<n, M> random_transition(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Transition<n, M> t;
  for (int i = 0; i < M; ++i) {
    for (int j = 0; j < n; ++j) t.top(i, j) = (i == j ? 1.0 : 0.0) + 0.1 * normal(random);
  }
  for (int j = 0; j < n; ++j) {
    t.decay[j] = j % 2 == 0 ? 1.0 : 0.9;
    t.noise[j] = 0.01 + 0.01 * std::abs(normal(random));
  }
  return t;
}

template <int M>
Matrix dense(const Transition<n, M>& t) {
  Matrix phi = Matrix::Zero();
  phi.topRows<M>() = t.top;
  for (int j = M; j < n; ++j) phi(j, j) = t.decay[j];
  return phi;
}

/// A linear system with random transitions and rows; forward pass, both smoothers and batch least squares.
template <int M>
void expect_smoothers_equal_batch() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const int epochs = 8, rows = 3;
  std::vector<Transition<n, M>> phi;
  std::vector<std::vector<UpdateRow<n>>> updates;
  std::vector<Vector> x_after, x_before;
  std::vector<Matrix> P_after;
  std::vector<std::vector<std::pair<Vector, double>>> measured(epochs);

  Vector x = Vector::Zero();
  Matrix P = Matrix::Identity();
  for (int k = 0; k < epochs; ++k) {
    phi.push_back(random_transition<M>(random));
    if (k > 0) {
      x = (dense(phi.back()) * x).eval();
      predict(P, phi.back());
    }
    x_before.push_back(x);
    updates.emplace_back();
    for (int r = 0; r < rows; ++r) {
      Vector h;
      for (int j = 0; j < n; ++j) h[j] = normal(random);
      const double z = normal(random);
      measured[std::size_t(k)].emplace_back(h, z);
      updates.back().push_back(update_row<n>(x, P, h, z, 0.5));
    }
    symmetrize<n>(P);
    x_after.push_back(x);
    P_after.push_back(P);
  }

  // Batch: unknowns are the states of all epochs; the noise of a step is Phi Q/2 Phi' + Q/2.
  const int size = n * epochs;
  Eigen::MatrixXd normal_matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  normal_matrix.topLeftCorner<n, n>() += Matrix::Identity();
  for (int k = 0; k < epochs; ++k) {
    for (const auto& [h, z] : measured[std::size_t(k)]) {
      normal_matrix.block<n, n>(n * k, n * k) += h * h.transpose() / 0.5;
      right.segment<n>(n * k) += h * z / 0.5;
    }
    if (k == 0) continue;
    const Matrix F = dense(phi[std::size_t(k)]);
    const Matrix half = 0.5 * Matrix(phi[std::size_t(k)].noise.asDiagonal());
    const Matrix W = (F * half * F.transpose() + half).inverse();
    Eigen::MatrixXd A(n, 2 * n);
    A << -F, Matrix::Identity();
    normal_matrix.block<2 * n, 2 * n>(n * (k - 1), n * (k - 1)) += A.transpose() * W * A;
  }
  const Eigen::MatrixXd covariance = normal_matrix.inverse();
  const Eigen::VectorXd batch = covariance * right;

  Adjoint<n> a(n);
  Vector rts_x = x_after.back();
  Matrix rts_P = P_after.back();
  for (int k = epochs - 1; k >= 0; --k) {
    const auto i = std::size_t(k);
    const Vector bf_x = x_after[i] - P_after[i] * a.lambda;
    const Matrix bf_P = P_after[i] - P_after[i] * a.Lambda * P_after[i];
    if (k + 1 < epochs) {
      Matrix gain, predicted;
      ASSERT_TRUE(rts_gain(P_after[i], phi[i + 1], gain, predicted));
      rts_x = (x_after[i] + gain * (rts_x - x_before[i + 1])).eval();
      rts_P = (P_after[i] + gain * (rts_P - predicted) * gain.transpose()).eval();
    }
    EXPECT_LT((bf_x - batch.segment<n>(n * k)).norm(), 1e-9) << k;
    EXPECT_LT((rts_x - batch.segment<n>(n * k)).norm(), 1e-9) << k;
    EXPECT_LT((bf_P - covariance.block(n * k, n * k, n, n)).norm(), 1e-9) << k;
    EXPECT_LT((rts_P - covariance.block(n * k, n * k, n, n)).norm(), 1e-9) << k;
    for (auto row = updates[i].rbegin(); row != updates[i].rend(); ++row) {
      undo_row<n>(a, row->h, row->gain, row->innovation, row->variance);
    }
    if (k > 0) undo_transition(a, phi[i]);
  }
}

TEST(Kernels, BothSmoothersEqualBatchLeastSquares) {
  expect_smoothers_equal_batch<moving>();
  expect_smoothers_equal_batch<moving_with_path>();
}

TEST(Kernels, DynamicSizeEqualsFixedSize) {
  std::mt19937 random(8);
  const Transition<n> t = random_transition<moving>(random);
  Transition<Eigen::Dynamic> d{t.top, t.decay, t.noise};
  Matrix P = Matrix::Identity();
  StateMatrix<Eigen::Dynamic> Q = P;
  predict(P, t);
  predict(Q, d);
  EXPECT_LT((P - Q).norm(), 1e-12);
  EXPECT_LT((P - (dense(t) * (Matrix::Identity() + 0.5 * Matrix(t.noise.asDiagonal())) * dense(t).transpose() +
                  0.5 * Matrix(t.noise.asDiagonal())))
                .norm(),
            1e-12);
}

TEST(Consistency, QuantilesAndMonitor) {
  EXPECT_NEAR(chi_square_quantile(0.95, 3), 7.8147, 1e-4);
  EXPECT_NEAR(Gate(1e-3).threshold(2), 13.8155, 1e-4);
  const Bounds b = mean_chi_square_bounds(100, 3.0);
  EXPECT_NEAR(b.lower, 0.8466, 2e-3);
  EXPECT_NEAR(b.upper, 1.1665, 2e-3);
  // A shift of one sigma, far below any gate, is found within the window; pure noise is not.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  InnovationMonitor quiet(30, 1e-6), shifted(30, 1e-6);
  bool false_alarm = false, found = false;
  for (int i = 0; i < 1000; ++i) {
    false_alarm |= quiet.add(Eigen::Vector2d(normal(random), normal(random)));
    found |= shifted.add(Eigen::Vector2d(1.0 + normal(random), normal(random)));
  }
  EXPECT_FALSE(false_alarm);
  EXPECT_TRUE(found);
}

TEST(StateBlocks, HandOutOffsetsAndNames) {
  Assembler a;
  const Block<3> position = a.add<3>("position", "ned");
  const Block<1> scale = a.add<1>("scale");
  EXPECT_EQ(position.offset, 0);
  EXPECT_EQ(scale.offset, 3);
  EXPECT_EQ(a.names()[1], "position_e");
  EXPECT_EQ(a.size(), 4);
}

}  // namespace
}  // namespace versine::filter
