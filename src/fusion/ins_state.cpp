// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/ins_state.hpp"

#include <algorithm>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {

InsLayout InsLayout::from(const AidedInsOptions& o, const Series<sensors::LandmarkSample>& landmarks) {
  filter::Assembler a;
  InsLayout l;
  l.position = a.add<3>("position", "ned");
  l.velocity = a.add<3>("velocity", "ned");
  l.attitude = a.add<3>("attitude", "ned");
  l.distance = a.add<1>("distance");
  if (o.constraint && o.constraint_wander > 0.0) {
    l.path.offset = a.add<1>("path_right").offset;
    a.add<1>("path_down");
  }
  l.gyro_bias = a.add<3>("gyro_bias", "xyz");
  l.accelerometer_bias = a.add<3>("accelerometer_bias", "xyz");
  l.gyro_scale = a.add<3>("gyro_scale", "xyz");
  l.accelerometer_scale = a.add<3>("accelerometer_scale", "xyz");
  l.odometer_scale = a.add<1>("odometer_scale");
  if (o.mounting_sigma > 0.0) {
    l.mounting.offset = a.add<1>("mounting_pitch").offset;
    a.add<1>("mounting_yaw");
  }
  if (o.gnss_lever.sigma > 0.0) l.gnss_lever = a.add<3>("gnss_lever", "xyz");
  if (o.wheel_lever.sigma > 0.0) l.wheel_lever = a.add<3>("wheel_lever", "xyz");
  if (o.gnss_bias > 0.0) l.gnss_bias = a.add<3>("gnss_bias", "ned");
  const auto shares = [](const sensors::LandmarkSample& s) { return s.shared.has_value(); };
  const auto shares_attitude = [](const sensors::LandmarkSample& s) { return s.shared && s.q_ns; };
  if (std::any_of(landmarks.samples.begin(), landmarks.samples.end(), shares)) {
    l.landmark_position = a.add<3>("landmark_error", "123");
    if (std::any_of(landmarks.samples.begin(), landmarks.samples.end(), shares_attitude)) {
      l.landmark_attitude = a.add<3>("landmark_error", "456");
    }
  }
  l.names = a.names();
  return l;
}

InsEstimate without_error(const InsEstimate& estimate, const InsLayout& l, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const auto part = [&x](auto block) { return x.segment<decltype(block)::size>(block.offset); };
  InsEstimate e = estimate;
  e.nav.position = geodesy::wgs84.displaced(e.nav.position, -part(l.position));
  e.nav.v_eb_n -= part(l.velocity);
  e.nav.q_nb = (geodesy::from_rotation_vector(part(l.attitude)) * e.nav.q_nb).normalized();
  e.distance -= x[l.distance.offset];
  if (l.path.enabled()) e.path -= part(l.path);
  e.imu.gyro_bias += part(l.gyro_bias);
  e.imu.accelerometer_bias += part(l.accelerometer_bias);
  e.imu.gyro_scale += part(l.gyro_scale);
  e.imu.accelerometer_scale += part(l.accelerometer_scale);
  e.odometer_scale += x[l.odometer_scale.offset];
  if (l.mounting.enabled()) {
    const Eigen::Vector2d eta = part(l.mounting);
    e.C_vb = geodesy::from_rotation_vector({0.0, eta[0], eta[1]}).toRotationMatrix() * e.C_vb;
  }
  if (l.gnss_lever.enabled()) e.gnss_lever += part(l.gnss_lever);
  if (l.wheel_lever.enabled()) e.wheel_lever += part(l.wheel_lever);
  if (l.gnss_bias.enabled()) e.gnss_bias += part(l.gnss_bias);
  if (l.landmark_position.enabled()) e.landmark_error.head<3>() += part(l.landmark_position);
  if (l.landmark_attitude.enabled()) e.landmark_error.tail<3>() += part(l.landmark_attitude);
  return e;
}

}  // namespace versine::fusion
