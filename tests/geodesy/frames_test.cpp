// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/TransverseMercatorExact.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/geodesy/projection.hpp"

namespace versine::geodesy {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Attitude, EulerMatrixAndQuaternionAreOneAttitude) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-pi, pi), pitch(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const Euler e{any(random), pitch(random), any(random)};
    const Eigen::Matrix3d c = to_matrix(e);
    EXPECT_LT((c * c.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(c.determinant(), 1.0, 1e-14);
    EXPECT_LT((to_quaternion(e).toRotationMatrix() - c).norm(), 1e-14);
    for (const Euler& back : {to_euler(c), to_euler(to_quaternion(e))}) {
      EXPECT_NEAR(std::remainder(back.roll - e.roll, 2.0 * pi), 0.0, 1e-13);
      EXPECT_NEAR(back.pitch, e.pitch, 1e-13);
      EXPECT_NEAR(std::remainder(back.yaw - e.yaw, 2.0 * pi), 0.0, 1e-13);
    }
  }
}

TEST(Attitude, AxesPointWhereTheConventionSays) {
  // Yaw from north clockwise: forward points east. Pitch up lifts the nose, roll lowers the right side (down positive).
  EXPECT_LT((to_matrix({0.0, 0.0, pi / 2.0}) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((to_matrix({0.0, 0.1, 0.0}) * Eigen::Vector3d::UnitX()).z(), 0.0);
  EXPECT_GT((to_matrix({0.1, 0.0, 0.0}) * Eigen::Vector3d::UnitY()).z(), 0.0);
}

TEST(Attitude, GimbalLockStillGivesTheSameMatrix) {
  for (const double p : {pi / 2.0, -pi / 2.0}) {
    const Eigen::Matrix3d c = to_matrix({0.3, p, 1.0});
    EXPECT_LT((to_matrix(to_euler(c)) - c).norm(), 1e-7);
  }
}

TEST(Attitude, RotationVectorsRoundTripFromNothingToHalfATurn) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const double size : {0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 3.0, pi - 1e-9}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d phi = size * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
      EXPECT_LT((to_rotation_vector(from_rotation_vector(phi)) - phi).norm(), 1e-8 * size + 1e-16) << size;
    }
  }
}

TEST(Attitude, WrapPiKeepsTheAngle) {
  for (double a = -20.0; a < 20.0; a += 0.37) {
    EXPECT_LE(std::abs(wrap_pi(a)), pi);
    EXPECT_NEAR(std::remainder(wrap_pi(a) - a, 2.0 * pi), 0.0, 1e-14);
  }
}

TEST(Projection, GaussKruegerAgreesWithTheExactTransverseMercator) {
  const GeographicLib::TransverseMercatorExact exact(6378137.0, 1.0 / 298.257223563, 1.0);
  const auto projection = Projection::transverse_mercator(11.37 * units::deg);
  ASSERT_TRUE(projection);
  for (double lat = -80.0; lat <= 80.0; lat += 8.0) {
    for (const double lon : {8.5, 10.0, 11.37, 13.0, 14.2}) {
      double x = 0, y = 0, gamma = 0, k = 0;
      exact.Forward(11.37, lat, lon, x, y, gamma, k);
      const Geodetic g{lat * units::deg, lon * units::deg, 321.0};
      const MapPoint p = projection->forward(g);
      EXPECT_NEAR(p.easting, x + 500000.0, 1e-6);
      EXPECT_NEAR(p.northing, y, 1e-6);
      EXPECT_NEAR(p.height, 321.0, 1e-6);
      const Geodetic back = projection->inverse(p);
      EXPECT_NEAR(back.latitude, g.latitude, 1e-13);
      EXPECT_NEAR(back.longitude, g.longitude, 1e-13);
      const auto d = projection->distortion(g);
      EXPECT_NEAR(d.scale, k, 1e-8);
      EXPECT_NEAR(d.convergence, gamma * units::deg, 1e-7);
    }
  }
}

TEST(Projection, UnknownAndGeographicSystemsAreRefusedByName) {
  for (const char* name : {"EPSG:4326", "EPSG:99999", "nonsense", ""}) {
    const auto projection = Projection::create(name);
    ASSERT_FALSE(projection) << name;
    EXPECT_EQ(projection.error().field, "crs");
  }
}

TEST(LocalFrame, AgreesWithGeographicLibAndReturns) {
  const Geodetic origin{51.2 * units::deg, 7.1 * units::deg, 210.0};
  const LocalFrame frame(origin);
  const GeographicLib::LocalCartesian reference(51.2, 7.1, 210.0);
  for (const double dlat : {-0.3, 0.0, 0.01, 0.4}) {
    for (const double dlon : {-0.5, 0.0, 0.02, 0.3}) {
      const Geodetic g{(51.2 + dlat) * units::deg, (7.1 + dlon) * units::deg, 180.0};
      double e = 0, n = 0, u = 0;
      reference.Forward(51.2 + dlat, 7.1 + dlon, 180.0, e, n, u);
      const Eigen::Vector3d ned = frame.to_ned(g);
      EXPECT_LT((ned - Eigen::Vector3d(n, e, -u)).norm(), 1e-8);
      const Geodetic back = frame.to_geodetic(ned);
      EXPECT_NEAR(back.latitude, g.latitude, 1e-15);
      EXPECT_NEAR(back.longitude, g.longitude, 1e-15);
      EXPECT_NEAR(back.height, g.height, 5e-9);
    }
  }
}

TEST(LocalFrame, TheGroundFallsAwayByTheEarthsCurvature) {
  const Geodetic origin{0.8, 0.1, 0.0};
  const LocalFrame frame(origin);
  const double angle = 1000.0 / wgs84.meridian_radius(0.8);
  EXPECT_NEAR(frame.to_ned({0.8 + angle, 0.1, 0.0}).z(), 1000.0 * angle / 2.0, 1e-4);  // 78 mm on a kilometre
  const Eigen::Matrix3d c = frame.rotation_from({0.8 + angle, 0.1, 0.0});
  EXPECT_LT((c.transpose() * c - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace versine::geodesy
