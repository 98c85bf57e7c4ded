// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "motion.hpp"
#include "versine/georef/on_path.hpp"

namespace versine::georef {

namespace {

/// States inside an interval of n steps given both its ends (a Markov bridge): x_k = M x_0 + K x_n + what the input
/// adds, with covariance B of what neither end tells.
struct Bridge {
  std::vector<Eigen::Matrix3d> M, K, B, F;
};

Bridge make_bridge(MotionTable& table, std::int64_t n) {
  Bridge b;
  static_cast<void>(table.steps(n));  // the table grows now, so that references into it hold
  const Motion& all = table.steps(n);
  const Eigen::Matrix3d inverse = all.Q.inverse();
  for (std::int64_t k = 0; k < n; ++k) {
    const Motion &to = table.steps(k), &from = table.steps(n - k);
    const Eigen::Matrix3d K = to.Q * from.F.transpose() * inverse;
    b.K.push_back(K);
    b.M.push_back(to.F - K * all.F);
    b.B.push_back(to.Q - K * from.F * to.Q);
    b.F.push_back(to.F);
  }
  return b;
}

/// Non-decreasing sequence nearest to the given one in the mean square (pool adjacent violators): unlike a running
/// maximum it does not push the distance forward.
void make_monotone(std::vector<double>& d) {
  struct Block {
    double sum;
    std::size_t count;
    [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
  };
  std::vector<Block> blocks;
  for (const double x : d) {
    blocks.push_back({x, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean() > blocks.back().mean()) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().sum += last.sum;
      blocks.back().count += last.count;
    }
  }
  std::size_t i = 0;
  for (const auto& b : blocks) {
    for (std::size_t k = 0; k < b.count; ++k) d[i++] = b.mean();
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
  out.distance.reserve(steps), out.speed.reserve(steps);
  out.sigma_distance.reserve(steps), out.sigma_speed.reserve(steps);
  const auto push = [&](double d, double s, double vd, double vs) {
    out.distance.push_back(d);
    out.speed.push_back(static_cast<float>(std::max(0.0, s)));
    out.sigma_distance.push_back(static_cast<float>(std::sqrt(std::max(vd, 0.0))));
    out.sigma_speed.push_back(static_cast<float>(std::sqrt(std::max(vs, 0.0))));
  };
  MotionTable table(epochs.motion, epochs.grid, epochs.correlation_time);
  std::map<std::int64_t, Bridge> bridges;
  const double T = epochs.grid;
  for (std::size_t i = 0; i + 1 < es.size(); ++i) {
    const std::int64_t n = es[i + 1].step - es[i].step;
    auto it = bridges.find(n);
    if (it == bridges.end()) it = bridges.emplace(n, make_bridge(table, n)).first;
    const Bridge& b = it->second;
    const Eigen::Vector3d x0 = smoothed.state[i].head<3>(), x1 = smoothed.state[i + 1].head<3>();
    Eigen::Matrix<double, 6, 6> J;
    J.topLeftCorner<3, 3>() = smoothed.covariance[i].topLeftCorner<3, 3>();
    J.bottomRightCorner<3, 3>() = smoothed.covariance[i + 1].topLeftCorner<3, 3>();
    J.topRightCorner<3, 3>() = (smoothed.gain[i] * smoothed.covariance[i + 1]).topLeftCorner<3, 3>();
    J.bottomLeftCorner<3, 3>() = J.topRightCorner<3, 3>().transpose();
    const Eigen::Vector3d end(es[i + 1].input.x(), es[i + 1].input.y(), 0.0);
    double cd = 0.0, cs = 0.0;  // what the input added so far
    for (std::int64_t k = 0; k < n; ++k) {
      const auto q = static_cast<std::size_t>(k);
      const Eigen::Vector3d x = b.M[q] * x0 + b.K[q] * (x1 - end) + Eigen::Vector3d(cd, cs, 0.0);
      Eigen::Matrix<double, 2, 6> G;
      G << b.M[q].topRows<2>(), b.K[q].topRows<2>();
      const Eigen::Matrix<double, 2, 6> GJ = G * J;
      push(x[0], x[1], GJ.row(0).dot(G.row(0)) + b.B[q](0, 0), GJ.row(1).dot(G.row(1)) + b.B[q](1, 1));
      if (!epochs.acceleration.empty()) {
        const double u = epochs.acceleration[static_cast<std::size_t>(es[i].step + k)];
        cd += T * cs + 0.5 * T * T * u;
        cs += T * u;
      }
    }
  }
  const State4& last = smoothed.state.back();
  push(last[0], last[1], smoothed.covariance.back()(0, 0), smoothed.covariance.back()(1, 1));
  make_monotone(out.distance);
  return out;
}

}  // namespace versine::georef
