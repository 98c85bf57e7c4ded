// SPDX-License-Identifier: Apache-2.0
#include "target_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {

Eigen::Vector3d local(const Target& t) {
  const double s = std::sin(t.zenith);
  return t.distance * Eigen::Vector3d(s * std::cos(t.direction), s * std::sin(t.direction), -std::cos(t.zenith));
}

Eigen::Vector3d prism(const ControlPoint& point, double target_height) {
  return point.position + target_height * up_at(point.position);
}

Observation observe(const Target& t, const ControlPoint& point, const Pose& pose, const Instrument& instrument) {
  Observation o{
      .place = prism(point, t.target_height), .direction = t.direction, .zenith = t.zenith, .distance = t.distance};
  const double target2 = instrument.target_sigma * instrument.target_sigma;
  const Eigen::Vector3d sigma(t.distance * std::sin(t.zenith) * t.direction_sigma, t.distance * t.zenith_sigma,
                              t.distance_sigma);
  const Eigen::Matrix3d axes = line_axes(pose, t.direction, t.zenith);
  o.covariance = axes * point.covariance * axes.transpose();
  o.covariance.diagonal() += sigma.cwiseAbs2() + Eigen::Vector3d::Constant(target2);
  o.whitening = Eigen::Matrix3d::Identity();
  o.covariance.llt().matrixL().solveInPlace(o.whitening);
  return o;
}

Discrepancy predict(const Candidate& c, const Adjustment& a, const Instrument& instrument) {
  const Observation o = observe(*c.target, *c.point, a.pose, instrument);
  const Eigen::Vector3d seen = a.pose.position + a.pose.q_ms * (a.scale * local(*c.target));
  const Eigen::Vector3d offset = seen - o.place;
  const Eigen::Matrix3d axes = line_axes(a.pose, o.direction, o.zenith);
  Eigen::Matrix3d covariance = axes.transpose() * o.covariance * axes;
  Eigen::Matrix<double, 3, 7> j;
  j << Eigen::Matrix3d::Identity(), -geodesy::skew(seen - a.pose.position), (seen - a.pose.position) / a.scale;
  covariance += j * a.covariance * j.transpose();
  return {offset, offset.dot(covariance.llt().solve(offset))};
}

TargetResult test_target(const Candidate& c, const Observation& o, const Adjustment& a, std::size_t i,
                         double detectable) {
  TargetResult r{.point = c.point->name, .readings = c.target->readings};
  const Eigen::Matrix3d block = Eigen::Matrix3d::Identity() - a.jacobian[i] * a.covariance * a.jacobian[i].transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
  // A direction in which the target alone carries the station cannot be tested: it has no redundancy.
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()(k) > 1e-6) {
      const double part = eigen.eigenvectors().col(k).dot(a.whitened[i]);
      r.point_test += part * part / eigen.eigenvalues()(k);
    }
  }
  r.gain = (a.covariance * a.jacobian[i].transpose() * a.jacobian[i]).topLeftCorner<6, 3>();
  const Eigen::Matrix3d unwhiten = o.whitening.inverse();
  r.residual = unwhiten * a.whitened[i];
  r.redundancy = (unwhiten * block * o.whitening).diagonal();
  const Eigen::Vector3d weighted = o.whitening.transpose() * a.whitened[i];
  const Eigen::Vector3d spread = (o.whitening.transpose() * block * o.whitening).diagonal().cwiseMax(0.0).cwiseSqrt();
  for (int k = 0; k < 3; ++k) {
    const bool tested = r.redundancy(k) > 1e-6;
    r.normalized(k) = tested ? weighted(k) / spread(k) : 0.0;
    r.detectable(k) = tested ? detectable / spread(k) : std::numeric_limits<double>::infinity();
  }
  return r;
}

}  // namespace versine::stationing
