// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/measurement_models.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {
namespace {
using Eigen::Vector3d;

/// A moment in which nothing is zero, and the truth that its estimate is off by an error `x`.
struct Scene {
  AidedInsOptions options;
  InsLayout layout;
  InsMoment moment;
  Scene() {
    options.mounting_sigma = options.gnss_lever.sigma = options.wheel_lever.sigma = options.gnss_bias = 0.1;
    layout = InsLayout::from(options);
    InsEstimate& e = moment.estimate;
    e.nav.position = {0.85, 0.2, 120.0};
    e.nav.v_eb_n = {7.0, -4.0, 0.5};
    e.nav.q_nb = geodesy::to_quaternion(geodesy::Euler{0.1, -0.2, -0.6});
    e.C_vb = geodesy::to_matrix(geodesy::Euler{0.02, 0.03, -0.04});
    e.gnss_lever = {0.5, -0.3, -1.2};
    e.wheel_lever = {-0.4, 0.7, 0.9};
    e.gnss_bias = {0.1, 0.2, -0.3};
    e.odometer_scale = 0.02;
    e.distance = 123.4;
    moment.omega_ib_b = {0.05, -0.1, 0.3};
    refresh();
  }
  void refresh() {
    moment.C_nb = moment.estimate.nav.q_nb.toRotationMatrix();
    moment.omega_nb_b = moment.omega_ib_b - moment.C_nb.transpose() * Vector3d(4e-5, 1e-5, -5e-5);
  }
  /// The estimate that is off from this one by x. The corrected rate is off by what is left of bias and scale factor.
  [[nodiscard]] InsMoment with_error(const Eigen::VectorXd& x) const {
    Scene s = *this;
    s.moment.estimate = without_error(moment.estimate, layout, -x);
    s.moment.omega_ib_b +=
        x.segment<3>(layout.gyro_bias.offset) + x.segment<3>(layout.gyro_scale.offset).cwiseProduct(moment.omega_ib_b);
    s.refresh();
    return s.moment;
  }
};

/// What the models leave out is the Earth rate seen through an attitude error on a lever arm: 7e-5 rad/s times 1 m.
void expect_jacobian(const Scene& scene, const std::function<filter::Linearized(const InsMoment&)>& model,
                     double tolerance) {
  const filter::Linearized l = model(scene.moment);
  for (int j = 0; j < scene.layout.size(); ++j) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(scene.layout.size());
    const double h = 1e-5;
    x[j] = h;
    const Eigen::VectorXd plus = model(scene.with_error(x)).z;
    x[j] = -h;
    const Eigen::VectorXd minus = model(scene.with_error(x)).z;
    const Eigen::VectorXd numeric = (plus - minus) / (2.0 * h);
    EXPECT_LT((numeric - l.H.col(j)).norm(), tolerance) << scene.layout.names[static_cast<std::size_t>(j)] << ": "
                                                        << numeric.transpose() << " / " << l.H.col(j).transpose();
  }
}

TEST(MeasurementModels, JacobiansMatchPerturbation) {
  const Scene s;
  sensors::GnssSample gnss;
  gnss.position = geodesy::wgs84.displaced(s.moment.estimate.nav.position, {1.0, 2.0, 3.0});
  gnss.v_ned = Vector3d(7.1, -4.2, 0.4);
  sensors::LandmarkSample landmark;
  landmark.position = gnss.position;
  landmark.covariance = landmark.attitude_covariance = Eigen::Matrix3d::Identity();
  landmark.q_ns = s.moment.estimate.nav.q_nb * geodesy::to_quaternion(geodesy::Euler{0.3, 0.2, 0.1});
  const Eigen::Quaterniond q_bs = geodesy::to_quaternion(geodesy::Euler{0.3, 0.2, 0.1});
  const InsLayout& l = s.layout;
  expect_jacobian(
      s, [&](const InsMoment& m) { return gnss_position(m, l, gnss, Vector3d::Ones()); }, 5e-5);
  expect_jacobian(
      s, [&](const InsMoment& m) { return gnss_velocity(m, l, gnss, Vector3d::Constant(0.1)); }, 2e-4);
  expect_jacobian(
      s,
      [&](const InsMoment& m) {
        return odometer_distance(m, l, {{}, 123.0}, 0.1);
      },
      1e-6);
  expect_jacobian(
      s,
      [&](const InsMoment& m) {
        return forward_speed(m, l, {{}, 8.0}, 0.1);
      },
      2e-4);
  expect_jacobian(
      s, [&](const InsMoment& m) { return constraint(m, l, 0.1); }, 2e-4);
  expect_jacobian(
      s, [&](const InsMoment& m) { return zero_velocity(m, l, m.estimate.nav.v_eb_n, 0.0, 0.1); }, 1e-6);
  expect_jacobian(
      s, [&](const InsMoment& m) { return zero_rate(m, l, 0.1); }, 1e-6);
  expect_jacobian(
      s, [&](const InsMoment& m) { return vehicle_heading(m, l, -0.6, 0.1); }, 1e-6);
  expect_jacobian(
      s,
      [&](const InsMoment& m) {
        return landmark_position(m, l, landmark, {0.2, 0.1, -1.0});
      },
      5e-5);
  expect_jacobian(
      s, [&](const InsMoment& m) { return landmark_attitude(m, l, landmark, q_bs); }, 1e-4);
}

TEST(MeasurementModels, MeanVelocityOfAStandingVehicleSeesHowTiltAndBiasBuildUp) {
  Scene s;
  s.options.mounting_sigma = s.options.gnss_lever.sigma = s.options.wheel_lever.sigma = s.options.gnss_bias = 0.0;
  s.layout = InsLayout::from(s.options);
  const InsLayout& l = s.layout;
  constexpr double window = 2.0;
  // Of an estimate whose force is off, the velocity half a window ago is that of the end less the force's error since.
  const geodesy::Geodetic& at = s.moment.estimate.nav.position;
  const Vector3d gravity = geodesy::wgs84.gravity_ned(at.latitude, at.height);
  const Vector3d force_b = -(s.moment.C_nb.transpose() * gravity);
  const inertial::ImuCorrection known = s.moment.estimate.imu;
  const auto mean = [&](const InsMoment& m) -> Vector3d {
    const Vector3d scale = m.estimate.imu.accelerometer_scale - known.accelerometer_scale;
    const Vector3d force =
        force_b - (m.estimate.imu.accelerometer_bias - known.accelerometer_bias) - scale.cwiseProduct(force_b);
    return m.estimate.nav.v_eb_n - 0.5 * window * (m.C_nb * force + gravity);
  };
  expect_jacobian(
      s, [&](const InsMoment& m) { return zero_velocity(m, l, mean(m), window, 0.1); }, 1e-4);
}

TEST(MeasurementModels, TheLayoutNamesEveryStateOnce) {
  const InsLayout plain = InsLayout::from({});
  EXPECT_EQ(plain.size(), 23);  // Chen's 22 and the odometer's distance
  EXPECT_EQ(plain.names[static_cast<std::size_t>(plain.odometer_scale.offset)], "odometer_scale");
  EXPECT_FALSE(plain.mounting.enabled());
}

}  // namespace
}  // namespace versine::fusion
