// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "motion.hpp"
#include "versine/georef/on_path.hpp"

namespace versine::georef {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector21 = Eigen::Matrix<double, 21, 1>;

/// Distance and speed inside an interval of n steps given both its ends (a Markov bridge), step by step:
/// (d, s)_k = G_k (x_0, x_n) + what the input adds, with what neither end tells. All steps at once are matrix times
/// vector: n rows of distances above n rows of speeds.
struct Bridge {
  Eigen::MatrixXd means;      ///< 2n x 6: G
  Eigen::MatrixXd variances;  ///< 2n x 21: of G J G^T's diagonal, from J's upper triangle
  Eigen::VectorXd between;    ///< 2n: variance that neither end tells
};

/// The upper triangle of J row by row, as `Bridge::variances` takes it.
Vector21 triangle(const Matrix6& J) {
  Vector21 out;
  for (int i = 0, at = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) out[at++] = J(i, k);
  }
  return out;
}

Bridge make_bridge(MotionTable& table, std::int64_t n) {
  Bridge b{Eigen::MatrixXd(2 * n, 6), Eigen::MatrixXd(2 * n, 21), Eigen::VectorXd(2 * n)};
  static_cast<void>(table.steps(n));  // the table grows now, so that references into it hold
  const Motion& all = table.steps(n);
  const Eigen::Matrix3d inverse = all.Q.inverse();
  for (std::int64_t k = 0; k < n; ++k) {
    const Motion &to = table.steps(k), &from = table.steps(n - k);
    const Eigen::Matrix3d K = to.Q * from.F.transpose() * inverse;
    const Eigen::Matrix3d M = to.F - K * all.F, B = to.Q - K * from.F * to.Q;
    for (int row = 0; row < 2; ++row) {
      const std::int64_t at = k + row * n;
      b.means.row(at) << M.row(row), K.row(row);
      b.between[at] = B(row, row);
      const Vector6 g = b.means.row(at);
      const Matrix6 outer = g * g.transpose();
      b.variances.row(at) = triangle(2.0 * outer - Matrix6(outer.diagonal().asDiagonal()));
    }
  }
  return b;
}

/// Non-decreasing sequence nearest to the given one in the mean square (pool adjacent violators): unlike a running
/// maximum it does not push the distance forward.
void make_monotone(std::vector<double>& d) {
  if (std::is_sorted(d.begin(), d.end())) return;
  struct Block {
    double mean, count;
  };
  std::vector<Block> blocks;
  blocks.reserve(d.size());
  for (const double x : d) {
    blocks.push_back({x, 1.0});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean > blocks.back().mean) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().count += last.count;
      blocks.back().mean += (last.mean - blocks.back().mean) * (last.count / blocks.back().count);
    }
  }
  std::size_t i = 0;
  for (const auto& b : blocks) {
    for (double k = 0.0; k < b.count; ++k) d[i++] = b.mean;
  }
  for (i = 1; i < d.size(); ++i) d[i] = std::max(d[i], d[i - 1]);  // rounding of the means
}

}  // namespace

Smoothed smooth(const Epochs& epochs, const Filtered& filtered) {
  const std::size_t n = epochs.epochs.size();
  MotionTable table(epochs.motion, epochs.grid, epochs.correlation_time);
  Smoothed out;
  out.state = filtered.updated;
  out.covariance = filtered.updated_covariance;
  out.gain.resize(n);
  for (std::size_t k = n - 1; k-- > 0;) {
    const Covariance4& P = filtered.updated_covariance[k];
    const Covariance4& next = filtered.predicted_covariance[k + 1];
    const Motion& m = table.steps(epochs.epochs[k + 1].step - epochs.epochs[k].step);
    Eigen::Matrix4d PF;  // P F^T
    PF.leftCols<3>() = P.leftCols<3>() * m.F.transpose();
    PF.col(3) = filtered.colour_kept[k + 1] * P.col(3);
    const Eigen::Matrix4d A = next.ldlt().solve(PF.transpose()).transpose();
    out.state[k] += A * (out.state[k + 1] - filtered.predicted[k + 1]);
    out.covariance[k] += A * (out.covariance[k + 1] - next) * A.transpose();
    out.gain[k] = A;
  }
  return out;
}

OnPath densify(const Epochs& epochs, const Smoothed& smoothed) {
  const auto& es = epochs.epochs;
  const auto steps = static_cast<std::size_t>(es.back().step) + 1;
  OnPath out;
  out.distance.resize(steps), out.speed.resize(steps);
  out.sigma_distance.resize(steps), out.sigma_speed.resize(steps);
  MotionTable table(epochs.motion, epochs.grid, epochs.correlation_time);
  std::map<std::int64_t, Bridge> bridges;
  const double T = epochs.grid;
  Eigen::VectorXd mean, sigma;
  for (std::size_t i = 0; i + 1 < es.size(); ++i) {
    const std::int64_t n = es[i + 1].step - es[i].step;
    auto it = bridges.find(n);
    if (it == bridges.end()) it = bridges.emplace(n, make_bridge(table, n)).first;
    const Bridge& b = it->second;
    Vector6 ends;
    ends << smoothed.state[i].head<3>(), smoothed.state[i + 1].head<3>();
    ends.segment<2>(3) -= es[i + 1].input;
    Matrix6 J;
    J.topLeftCorner<3, 3>() = smoothed.covariance[i].topLeftCorner<3, 3>();
    J.bottomRightCorner<3, 3>() = smoothed.covariance[i + 1].topLeftCorner<3, 3>();
    J.topRightCorner<3, 3>() = smoothed.gain[i].topRows<3>() * smoothed.covariance[i + 1].leftCols<3>();
    mean.noalias() = b.means * ends;
    sigma = b.between;
    sigma.noalias() += b.variances * triangle(J);
    sigma = sigma.cwiseMax(0.0).cwiseSqrt();
    double cd = 0.0, cs = 0.0;  // what the input added so far
    for (std::int64_t k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(es[i].step + k);
      out.distance[at] = mean[k] + cd;
      out.speed[at] = static_cast<float>(std::max(0.0, mean[n + k] + cs));
      out.sigma_distance[at] = static_cast<float>(sigma[k]);
      out.sigma_speed[at] = static_cast<float>(sigma[n + k]);
      if (epochs.acceleration.empty()) continue;
      const double u = epochs.acceleration[at];
      cd += T * cs + 0.5 * T * T * u;
      cs += T * u;
    }
  }
  const State4& last = smoothed.state.back();
  const auto& P = smoothed.covariance.back();
  out.distance.back() = last[0];
  out.speed.back() = static_cast<float>(std::max(0.0, last[1]));
  out.sigma_distance.back() = static_cast<float>(std::sqrt(std::max(P(0, 0), 0.0)));
  out.sigma_speed.back() = static_cast<float>(std::sqrt(std::max(P(1, 1), 0.0)));
  make_monotone(out.distance);
  return out;
}

}  // namespace versine::georef
