// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/measurement_models.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::fusion {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geodesy::skew;

WheelVelocity wheel_velocity(const InsMoment& m, const InsLayout& layout) {
  const InsEstimate& e = m.estimate;
  const Matrix3d C_bn = m.C_nb.transpose();
  WheelVelocity w;
  w.v_v = e.C_vb * (C_bn * e.nav.v_eb_n + m.omega_nb_b.cross(e.wheel_lever));
  w.H.setZero(3, layout.size());
  const Matrix3d C_vn = e.C_vb * C_bn;
  w.H.middleCols<3>(layout.velocity.offset) = C_vn;
  w.H.middleCols<3>(layout.attitude.offset) = -C_vn * skew(e.nav.v_eb_n);
  const Matrix3d rate = -e.C_vb * skew(e.wheel_lever);
  w.H.middleCols<3>(layout.gyro_bias.offset) = rate;
  w.H.middleCols<3>(layout.gyro_scale.offset) = rate * m.omega_ib_b.asDiagonal();
  if (layout.mounting.enabled()) w.H.middleCols<2>(layout.mounting.offset) = skew(w.v_v).rightCols<2>();
  if (layout.wheel_lever.enabled()) w.H.middleCols<3>(layout.wheel_lever.offset) = -e.C_vb * skew(m.omega_nb_b);
  return w;
}

InsMoment on_wheels(const InsMoment& m) {
  InsMoment along = m;
  InsEstimate& e = along.estimate;
  const Vector3d swing_b = m.omega_nb_b.cross(e.wheel_lever);
  const double speed = e.C_vb.row(0).dot(m.C_nb.transpose() * e.nav.v_eb_n + swing_b);
  e.nav.v_eb_n = m.C_nb * (e.C_vb.row(0).transpose() * speed - swing_b);
  return along;
}

DistanceRate distance_rate(const InsMoment& m, const InsLayout& layout) {
  return distance_rate(wheel_velocity(m, layout), m, layout);
}

DistanceRate distance_rate(const WheelVelocity& w, const InsMoment& m, const InsLayout& layout) {
  const double k = 1.0 + m.estimate.odometer_scale;
  DistanceRate d{k * w.v_v.x(), k * w.H.row(0)};
  d.H[layout.odometer_scale.offset] = -w.v_v.x();
  return d;
}

filter::Linearized odometer_distance(const InsMoment& m, const InsLayout& layout, const sensors::OdometerSample& sample,
                                     double sigma) {
  filter::Linearized l(1, layout.size());
  l.z[0] = m.estimate.distance - sample.distance;
  l.H(0, layout.distance.offset) = 1.0;
  l.R(0, 0) = sigma * sigma;
  return l;
}

filter::Linearized forward_speed(const InsMoment& m, const InsLayout& layout, const sensors::SpeedSample& sample,
                                 double sigma) {
  filter::Linearized l(1, layout.size());
  const DistanceRate d = distance_rate(m, layout);
  l.z[0] = d.rate - sample.speed;
  l.H.row(0) = d.H;
  l.R(0, 0) = sigma * sigma;
  return l;
}

filter::Linearized wheel_path(const InsMoment& m, const InsLayout& layout, double sigma) {
  filter::Linearized l(2, layout.size());
  l.z = m.estimate.path;
  l.H.middleCols<2>(layout.path.offset).setIdentity();
  l.R.diagonal().setConstant(sigma * sigma);
  return l;
}

filter::Linearized constraint(const InsMoment& m, const InsLayout& layout, double sigma) {
  filter::Linearized l(2, layout.size());
  const WheelVelocity w = wheel_velocity(m, layout);
  l.z = w.v_v.tail<2>();
  l.H = w.H.bottomRows<2>();
  l.R.diagonal().setConstant(sigma * sigma);
  return l;
}

}  // namespace versine::fusion
