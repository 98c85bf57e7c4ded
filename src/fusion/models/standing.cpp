// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "versine/fusion/measurement_models.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {

using Eigen::Matrix3d;
using Eigen::Vector3d;

filter::Linearized zero_velocity(const InsMoment& m, const InsLayout& layout, const Vector3d& mean, double seconds,
                                 double sigma) {
  filter::Linearized l(3, layout.size());
  l.z = mean;
  l.H.middleCols<3>(layout.velocity.offset).setIdentity();
  // Half a window ago the error of the velocity was less by what tilt and accelerometers have made since.
  const geodesy::Geodetic& place = m.estimate.nav.position;
  const Vector3d force_n = -geodesy::wgs84.gravity_ned(place.latitude, place.height);
  l.H.middleCols<3>(layout.attitude.offset) = -0.5 * seconds * geodesy::skew(force_n);
  l.H.middleCols<3>(layout.accelerometer_bias.offset) = -0.5 * seconds * m.C_nb;
  l.H.middleCols<3>(layout.accelerometer_scale.offset) =
      -0.5 * seconds * m.C_nb * (m.C_nb.transpose() * force_n).asDiagonal();
  l.R.diagonal().setConstant(sigma * sigma);
  return l;
}

filter::Linearized zero_rate(const InsMoment& m, const InsLayout& layout, double sigma) {
  filter::Linearized l(3, layout.size());
  // omega_nb = omega_ib - C_bn omega_in: the gyros' residual errors, and Earth rate seen through a wrong attitude.
  l.z = m.omega_nb_b;
  l.H.middleCols<3>(layout.gyro_bias.offset).setIdentity();
  l.H.middleCols<3>(layout.gyro_scale.offset) = m.omega_ib_b.asDiagonal();
  const Vector3d omega_in_n = m.C_nb * (m.omega_ib_b - m.omega_nb_b);
  l.H.middleCols<3>(layout.attitude.offset) = m.C_nb.transpose() * geodesy::skew(omega_in_n);
  l.R.diagonal().setConstant(sigma * sigma);
  return l;
}

filter::Linearized vehicle_heading(const InsMoment& m, const InsLayout& layout, double heading, double sigma) {
  filter::Linearized l(1, layout.size());
  const Vector3d x = m.C_nb * m.estimate.C_vb.row(0).transpose();  // forward axis of v in n
  const double level2 = x.head<2>().squaredNorm();
  l.z[0] = geodesy::wrap_pi(std::atan2(x.y(), x.x()) - heading);
  // x_hat = x - phi x x: d(atan2) = (x dy - y dx) / level^2.
  const Eigen::RowVector3d gradient(-x.y() / level2, x.x() / level2, 0.0);
  l.H.middleCols<3>(layout.attitude.offset) = gradient * geodesy::skew(x);
  if (layout.mounting.enabled()) {
    // C_vb = (I + eta x) C_vb_hat turns the forward axis, the first row of C_vb, by eta x e1.
    const Matrix3d C_nv = m.C_nb * m.estimate.C_vb.transpose();
    l.H(0, layout.mounting.offset) = -gradient.dot(C_nv.col(2));
    l.H(0, layout.mounting.offset + 1) = gradient.dot(C_nv.col(1));
  }
  l.R(0, 0) = sigma * sigma;
  return l;
}

namespace {

/// The landmark's shared error as states: `first` row of the sample's error, 0 position, 3 attitude. What is left of R
/// is the landmark's own.
void add_shared(const InsMoment& m, const InsLayout& layout, const sensors::LandmarkSample& sample, int first,
                filter::Linearized& l) {
  if (!sample.shared || !layout.landmark_position.enabled()) return;
  const auto root = sample.shared->root.middleRows<3>(first);
  l.z += root * m.estimate.landmark_error;
  l.H.middleCols<3>(layout.landmark_position.offset) = -root.leftCols<3>();
  if (layout.landmark_attitude.enabled()) l.H.middleCols<3>(layout.landmark_attitude.offset) = -root.rightCols<3>();
  l.R -= root * root.transpose();
}

}  // namespace

filter::Linearized landmark_position(const InsMoment& m, const InsLayout& layout, const sensors::LandmarkSample& sample,
                                     const Vector3d& lever_b) {
  filter::Linearized l(3, layout.size());
  const Vector3d lever_n = m.C_nb * lever_b;
  l.z = geodesy::wgs84.ned_difference(sample.position, m.estimate.nav.position) + lever_n;
  l.H.middleCols<3>(layout.position.offset).setIdentity();
  l.H.middleCols<3>(layout.attitude.offset) = geodesy::skew(lever_n);
  l.R = sample.covariance;
  add_shared(m, layout, sample, 0, l);
  return l;
}

filter::Linearized landmark_attitude(const InsMoment& m, const InsLayout& layout, const sensors::LandmarkSample& sample,
                                     const Eigen::Quaterniond& q_bs) {
  filter::Linearized l(3, layout.size());
  // q_hat = (I - phi x) q: the rotation from the estimate to the measured attitude is phi.
  const Eigen::Quaterniond measured = *sample.q_ns * q_bs.conjugate();
  l.z = geodesy::to_rotation_vector(measured * m.estimate.nav.q_nb.conjugate());
  l.H.middleCols<3>(layout.attitude.offset).setIdentity();
  l.R = sample.attitude_covariance;
  add_shared(m, layout, sample, 3, l);
  return l;
}

filter::Linearized landmark_attitude_after_position(const InsMoment& m, const InsLayout& layout,
                                                    const sensors::LandmarkSample& sample, const Vector3d& lever_b,
                                                    const Eigen::Quaterniond& q_bs) {
  filter::Linearized l = landmark_attitude(m, layout, sample, q_bs);
  const filter::Linearized p = landmark_position(m, layout, sample, lever_b);
  // The part of the attitude's noise that the position's does not share (Bryson and Ho, sequential processing).
  Matrix3d both = sample.position_attitude;
  if (sample.shared && layout.landmark_position.enabled()) {
    both -= sample.shared->root.topRows<3>() * sample.shared->root.bottomRows<3>().transpose();
  }
  const Matrix3d K = Matrix3d(p.R).llt().solve(both).transpose();
  l.z -= K * p.z;
  l.H -= K * p.H;
  l.R -= K * both;
  return l;
}

}  // namespace versine::fusion
