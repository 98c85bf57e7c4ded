// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/ellipsoid.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>

#include "versine/core/units.hpp"

namespace versine::geodesy {
namespace {

TEST(Ellipsoid, EcefAgreesWithGeographicLib) {
  const auto& earth = GeographicLib::Geocentric::WGS84();
  for (double lat = -90; lat <= 90; lat += 7.5) {
    for (double lon = -180; lon < 180; lon += 33) {
      for (const double h : {-500.0, 0.0, 420.0, 9000.0, 400e3}) {
        double x = 0, y = 0, z = 0;
        earth.Forward(lat, lon, h, x, y, z);
        const Ecef e = wgs84.to_ecef({lat * units::deg, lon * units::deg, h});
        EXPECT_LT((e.r - Eigen::Vector3d(x, y, z)).norm(), 5e-9);
        const Geodetic g = wgs84.to_geodetic(e);
        EXPECT_NEAR(g.latitude, lat * units::deg, 2e-16 + 1e-15);
        EXPECT_NEAR(g.height, h, 5e-9);
      }
    }
  }
}

TEST(Ellipsoid, GravityAgreesWithGeographicLib) {
  for (const auto& [ours, theirs] :
       {std::pair{wgs84, &GeographicLib::NormalGravity::WGS84()}, {grs80, &GeographicLib::NormalGravity::GRS80()}}) {
    for (double lat = -90; lat <= 90; lat += 10) {
      for (const double h : {-400.0, 0.0, 420.0, 3000.0}) {
        double north = 0, up = 0;
        theirs->Gravity(lat, h, north, up);
        const Eigen::Vector3d g = ours.gravity_ned(lat * units::deg, h);
        EXPECT_NEAR(g.z(), -up, 1e-6) << lat << " " << h;
        EXPECT_NEAR(g.x(), north, 3e-7 + 1e-10 * std::abs(h)) << lat << " " << h;
      }
    }
  }
}

}  // namespace
}  // namespace versine::geodesy
