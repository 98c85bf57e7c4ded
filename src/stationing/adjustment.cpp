// SPDX-License-Identifier: Apache-2.0
#include "adjustment.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>

#include <Eigen/Eigenvalues>

#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {
namespace {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// The vector from the moved instrument to a place, in s: C_sm Exp(-theta) (x - p - dp).
template <class T>
Vector3<T> in_instrument(const Pose& pose, const Eigen::Vector3d& x, const T* correction) {
  const Vector3<T> d = (x - pose.position).template cast<T>() - Vector3<T>(correction[0], correction[1], correction[2]);
  const T turn[3] = {-correction[3], -correction[4], -correction[5]};
  Vector3<T> turned;
  ceres::AngleAxisRotatePoint(turn, d.data(), turned.data());
  return pose.q_ms.conjugate().toRotationMatrix().template cast<T>() * turned;
}

struct TargetResidual {
  const Observation& observation;
  const Pose& pose;
  template <class T>
  bool operator()(const T* correction, const T* scale, T* residual) const {
    const Observation& o = observation;
    const Vector3<T> v = in_instrument(pose, o.place, correction);
    Eigen::Map<Vector3<T>> r(residual);
    r = o.whitening.template cast<T>() * misclosure<T>(v, *scale, o.direction, o.zenith, o.distance);
    return true;
  }
};

/// The plumb line has no component across the direction that is told to be up.
struct PlumbResidual {
  const Pose& pose;
  const Plumb& plumb;
  template <class T>
  bool operator()(const T* correction, T* residual) const {
    const T turned[6] = {T(0.0), T(0.0), T(0.0), correction[3], correction[4], correction[5]};
    const Vector3<T> up = in_instrument(pose, Eigen::Vector3d(pose.position + up_at(pose.position)), turned);
    const Eigen::Vector3d x = plumb.up_s.cross(Eigen::Vector3d::UnitX()).normalized().cross(plumb.up_s);
    const Eigen::Vector3d y = plumb.up_s.cross(x);
    residual[0] = up.dot(x.template cast<T>()) / plumb.sigma;
    residual[1] = up.dot(y.template cast<T>()) / plumb.sigma;
    return true;
  }
};

using TargetCost = ceres::AutoDiffCostFunction<TargetResidual, 3, 6, 1>;
using PlumbCost = ceres::AutoDiffCostFunction<PlumbResidual, 2, 6>;

/// Moves the pose by the solved corrections.
void apply(const double* correction, Pose& pose) {
  pose.position += Eigen::Map<const Eigen::Vector3d>(correction);
  pose.q_ms =
      (geodesy::from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(correction + 3)) * pose.q_ms).normalized();
}

/// Residuals, Jacobians and the covariance at the solution.
void evaluate(const std::vector<Observation>& observations, const AdjustmentSettings& settings, Adjustment& a) {
  const double zero[6] = {};
  const double* parameters[2] = {zero, &a.scale};
  Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
  a.squares = 0.0;
  for (const Observation& o : observations) {
    Eigen::Vector3d residual;
    Eigen::Matrix<double, 3, 6, Eigen::RowMajor> by_pose;
    Eigen::Vector3d by_scale;
    double* jacobians[2] = {by_pose.data(), by_scale.data()};
    TargetCost(new TargetResidual{o, a.pose}).Evaluate(parameters, residual.data(), jacobians);
    Eigen::Matrix<double, 3, 7> j;
    j << by_pose, by_scale;
    if (!settings.solve_scale) j.col(6).setZero();
    normal += j.transpose() * j;
    a.squares += residual.squaredNorm();
    a.whitened.push_back(residual);
    a.jacobian.push_back(j);
  }
  if (settings.plumb) {
    Eigen::Vector2d residual;
    Eigen::Matrix<double, 2, 6, Eigen::RowMajor> j;
    double* jacobians[1] = {j.data()};
    PlumbCost(new PlumbResidual{a.pose, *settings.plumb}).Evaluate(parameters, residual.data(), jacobians);
    normal.topLeftCorner<6, 6>() += j.transpose() * j;
    a.squares += residual.squaredNorm();
  }
  const int unknowns = settings.solve_scale ? 7 : 6;
  a.redundancy = static_cast<int>(3 * observations.size()) + (settings.plumb ? 2 : 0) - unknowns;
  if (!settings.solve_scale) normal(6, 6) = 1.0;
  // Unit diagonal first, so that metres and radians weigh the same in the rank decision.
  const Eigen::Matrix<double, 7, 1> d = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>> eigen(d.asDiagonal() * normal * d.asDiagonal());
  a.regular = eigen.eigenvalues()(0) > 1e-10;
  if (!a.regular) return;
  a.covariance =
      d.asDiagonal() *
      (eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose()) *
      d.asDiagonal();
  if (!settings.solve_scale) a.covariance(6, 6) = 0.0;
}

}  // namespace

Eigen::Matrix3d line_axes(const Pose& pose, double direction, double zenith) {
  const double cr = std::cos(direction), sr = std::sin(direction), cz = std::cos(zenith), sz = std::sin(zenith);
  Eigen::Matrix3d rows;
  rows << -sr, cr, 0.0,         // towards larger directions
      -cz * cr, -cz * sr, -sz,  // towards smaller zenith angles
      sz * cr, sz * sr, -cz;
  return rows * pose.q_ms.conjugate().toRotationMatrix();
}

Adjustment adjust(const std::vector<Observation>& observations, const Pose& start, double start_scale,
                  const AdjustmentSettings& settings) {
  Adjustment a;
  a.pose = start;
  a.scale = start_scale;
  double correction[6] = {};
  ceres::Problem problem;
  for (const Observation& o : observations) {
    problem.AddResidualBlock(new TargetCost(new TargetResidual{o, start}),
                             settings.robust ? new ceres::CauchyLoss(2.5) : nullptr, correction, &a.scale);
  }
  if (settings.plumb) {
    problem.AddResidualBlock(new PlumbCost(new PlumbResidual{start, *settings.plumb}), nullptr, correction);
  }
  if (!settings.solve_scale) problem.SetParameterBlockConstant(&a.scale);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  apply(correction, a.pose);
  evaluate(observations, settings, a);
  return a;
}

}  // namespace versine::stationing
