// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <ceres/cost_function.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "adjustment.hpp"

/// Ceres cost functors of a network: one for each kind of observation. Attitudes are rotation vectors in the m-frame
/// about the start value `q`.
namespace versine::stationing {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Vector3<T> to_instrument(const Eigen::Quaterniond& q, const T* theta, const Vector3<T>& d) {
  const T turn[3] = {-theta[0], -theta[1], -theta[2]};
  Vector3<T> turned;
  ceres::AngleAxisRotatePoint(turn, d.data(), turned.data());
  return q.conjugate().toRotationMatrix().template cast<T>() * turned;
}

struct SightingResidual {
  Eigen::Quaterniond q;
  Eigen::Vector3d rise;  ///< prism's height over its point less the instrument's over its mark, m-frame
  Eigen::Vector3d observed;
  Eigen::Vector3d sigma;
  template <class T>
  bool operator()(const T* mark, const T* theta, const T* point, T* residual) const {
    const Eigen::Map<const Vector3<T>> a(mark), b(point);
    const Vector3<T> v = to_instrument<T>(q, theta, b - a + rise.template cast<T>());
    const Vector3<T> r = misclosure<T>(v, T(1.0), observed(0), observed(1), observed(2));
    for (int k = 0; k < 3; ++k) residual[k] = r(k) / sigma(k);
    return true;
  }
};

struct LevelResidual {
  Eigen::Quaterniond q;
  Eigen::Vector3d up;
  double sigma;
  template <class T>
  bool operator()(const T* theta, T* residual) const {
    const Vector3<T> u = to_instrument<T>(q, theta, up.template cast<T>());
    residual[0] = u(0) / sigma;
    residual[1] = u(1) / sigma;
    return true;
  }
};

struct PositionResidual {
  Eigen::Vector3d given;
  Eigen::Matrix3d whitening;
  template <class T>
  bool operator()(const T* point, T* residual) const {
    Eigen::Map<Vector3<T>>(residual, 3) =
        whitening.template cast<T>() * (Eigen::Map<const Vector3<T>>(point) - given.template cast<T>());
    return true;
  }
};

/// The figure of several stations: linear in their marks.
class FigureCost : public ceres::CostFunction {
 public:
  FigureCost(Eigen::VectorXd given, const Eigen::MatrixXd& covariance)
      : given_(std::move(given)), whitening_(Eigen::MatrixXd::Identity(given_.size(), given_.size())) {
    covariance.llt().matrixL().solveInPlace(whitening_);
    set_num_residuals(static_cast<int>(given_.size()));
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(given_.size() / 3), 3);
  }

  bool Evaluate(const double* const* marks, double* residuals, double** jacobians) const override {
    const auto n = given_.size() / 3;
    Eigen::VectorXd off = -given_;
    for (Eigen::Index i = 0; i < n; ++i) off.segment<3>(3 * i) += Eigen::Map<const Eigen::Vector3d>(marks[i]);
    Eigen::Map<Eigen::VectorXd>(residuals, given_.size()) = whitening_ * off;
    using Block = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    for (Eigen::Index i = 0; jacobians != nullptr && i < n; ++i) {
      if (jacobians[i] != nullptr) Eigen::Map<Block>(jacobians[i], given_.size(), 3) = whitening_.middleCols<3>(3 * i);
    }
    return true;
  }

 private:
  Eigen::VectorXd given_;
  Eigen::MatrixXd whitening_;
};

}  // namespace versine::stationing
