// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace versine::stationing {

/// Three observations of unit variance in a linear model: l = by_pose x[pose ..] + by_point x[point ..] + noise.
struct JointBlock {
  Eigen::Index pose = -1, point = -1;  ///< first columns; pose -1: coordinates of a control point
  Eigen::Matrix<double, 3, 7> by_pose = Eigen::Matrix<double, 3, 7>::Zero();
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
  Eigen::Vector3d observed = Eigen::Vector3d::Zero();
  bool used = true;
};

/// The least squares of some blocks, updated as blocks go and come.
class JointWindow {
 public:
  /// Columns are held by `weak` (sigma of each, in its unit), so that what nothing determines stays finite.
  JointWindow(std::vector<JointBlock> blocks, const Eigen::VectorXd& weak) : blocks_(std::move(blocks)) {
    Eigen::MatrixXd normal = weak.cwiseAbs2().cwiseInverse().asDiagonal();
    right_ = Eigen::VectorXd::Zero(weak.size());
    for (const JointBlock& b : blocks_) {
      if (!b.used) continue;
      const Eigen::MatrixXd a = rows_of(b);
      add_normal(b, normal);
      right_ += a.transpose() * b.observed;
    }
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    cofactor_ = scale.asDiagonal() *
                (scale.asDiagonal() * normal * scale.asDiagonal())
                    .llt()
                    .solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())) *
                scale.asDiagonal();
    solution_ = cofactor_ * right_;
  }

  [[nodiscard]] const std::vector<JointBlock>& blocks() const { return blocks_; }
  [[nodiscard]] const Eigen::VectorXd& solution() const { return solution_; }

  /// Largest sigma of `count` unknowns from `first`.
  [[nodiscard]] double sigma(Eigen::Index first, Eigen::Index count) const {
    return std::sqrt(cofactor_.diagonal().segment(first, count).maxCoeff());
  }

  /// Normalised size of a block's contradiction with the (other) blocks in use; chi-square with 3 degrees of freedom.
  /// 0 where nothing checks it.
  [[nodiscard]] double test(std::size_t i) const {
    const JointBlock& b = blocks_[i];
    const Eigen::Vector3d v = b.observed - computed(b);
    const Eigen::Matrix3d carried = spread(b);
    const Eigen::Matrix3d r = Eigen::Matrix3d::Identity() + (b.used ? -1.0 : 1.0) * carried;
    const Eigen::LLT<Eigen::Matrix3d> llt(r);
    // The redundancy of the block's weakest direction: below it rounding would be tested.
    if (llt.info() != Eigen::Success || llt.matrixLLT().diagonal().cwiseAbs2().minCoeff() < 1e-4) return 0.0;
    return v.dot(llt.solve(v));
  }

  /// Takes a block out or in: an update of rank three.
  void toggle(std::size_t i) {
    JointBlock& b = blocks_[i];
    const double sign = b.used ? -1.0 : 1.0;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> qa = cofactor_rows(b);
    const Eigen::Matrix3d inner = Eigen::Matrix3d::Identity() + sign * spread(b);
    cofactor_ -= sign * qa * inner.inverse() * qa.transpose();
    right_ += sign * rows_of(b).transpose() * b.observed;
    solution_ = cofactor_ * right_;
    b.used = !b.used;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd rows_of(const JointBlock& b) const {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, right_.size());
    if (b.pose >= 0) a.middleCols<7>(b.pose) = b.by_pose;
    a.middleCols<3>(b.point) += b.by_point;
    return a;
  }
  static void add_normal(const JointBlock& b, Eigen::MatrixXd& n) {
    n.block<3, 3>(b.point, b.point) += b.by_point.transpose() * b.by_point;
    if (b.pose < 0) return;
    n.block<7, 7>(b.pose, b.pose) += b.by_pose.transpose() * b.by_pose;
    n.block<7, 3>(b.pose, b.point) += b.by_pose.transpose() * b.by_point;
    n.block<3, 7>(b.point, b.pose) += b.by_point.transpose() * b.by_pose;
  }
  [[nodiscard]] Eigen::Vector3d computed(const JointBlock& b) const {
    Eigen::Vector3d c = b.by_point * solution_.segment<3>(b.point);
    if (b.pose >= 0) c += b.by_pose * solution_.segment<7>(b.pose);
    return c;
  }
  /// Q A'.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 3> cofactor_rows(const JointBlock& b) const {
    Eigen::Matrix<double, Eigen::Dynamic, 3> qa = cofactor_.middleCols<3>(b.point) * b.by_point.transpose();
    if (b.pose >= 0) qa += cofactor_.middleCols<7>(b.pose) * b.by_pose.transpose();
    return qa;
  }
  /// A Q A'.
  [[nodiscard]] Eigen::Matrix3d spread(const JointBlock& b) const {
    Eigen::Matrix3d s = b.by_point * cofactor_.block<3, 3>(b.point, b.point) * b.by_point.transpose();
    if (b.pose < 0) return s;
    const Eigen::Matrix3d cross = b.by_pose * cofactor_.block<7, 3>(b.pose, b.point) * b.by_point.transpose();
    s += b.by_pose * cofactor_.block<7, 7>(b.pose, b.pose) * b.by_pose.transpose() + cross + cross.transpose();
    return s;
  }

  std::vector<JointBlock> blocks_;
  Eigen::MatrixXd cofactor_;
  Eigen::VectorXd right_, solution_;
};

}  // namespace versine::stationing
