// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/measurement_models.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geodesy::skew;

filter::Linearized gnss_position(const InsMoment& m, const InsLayout& layout, const sensors::GnssSample& sample,
                                 const Vector3d& sigma_ned) {
  filter::Linearized l(3, layout.size());
  const InsEstimate& e = m.estimate;
  const Vector3d lever_n = m.C_nb * e.gnss_lever;
  l.z = geodesy::wgs84.ned_difference(sample.position, e.nav.position) + lever_n + e.gnss_bias;
  l.H.middleCols<3>(layout.position.offset).setIdentity();
  l.H.middleCols<3>(layout.attitude.offset) = skew(lever_n);
  if (layout.gnss_lever.enabled()) l.H.middleCols<3>(layout.gnss_lever.offset) = -m.C_nb;
  if (layout.gnss_bias.enabled()) l.H.middleCols<3>(layout.gnss_bias.offset) = -Matrix3d::Identity();
  l.R.diagonal() = sigma_ned.cwiseAbs2();
  return l;
}

filter::Linearized gnss_velocity(const InsMoment& m, const InsLayout& layout, const sensors::GnssSample& sample,
                                 const Vector3d& sigma_ned) {
  filter::Linearized l(3, layout.size());
  const InsEstimate& e = m.estimate;
  const Vector3d swing_b = m.omega_nb_b.cross(e.gnss_lever), swing_n = m.C_nb * swing_b;
  l.z = e.nav.v_eb_n + swing_n - *sample.v_ned;
  l.H.middleCols<3>(layout.velocity.offset).setIdentity();
  l.H.middleCols<3>(layout.attitude.offset) = skew(swing_n);
  const Matrix3d rate = -m.C_nb * skew(e.gnss_lever);
  l.H.middleCols<3>(layout.gyro_bias.offset) = rate;
  l.H.middleCols<3>(layout.gyro_scale.offset) = rate * m.omega_ib_b.asDiagonal();
  if (layout.gnss_lever.enabled()) l.H.middleCols<3>(layout.gnss_lever.offset) = -m.C_nb * skew(m.omega_nb_b);
  l.R.diagonal() = sigma_ned.cwiseAbs2();
  return l;
}

}  // namespace versine::fusion
