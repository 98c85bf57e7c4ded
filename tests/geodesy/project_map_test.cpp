// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/project_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "versine/core/units.hpp"

namespace versine::geodesy {
namespace {

/// A project grid 3 degrees off, 25 ppm larger, with heights 45.2 m lower.
TEST(ProjectMap, CommonPointsLeadToTheProjectsGridAndHeights) {
  const auto projection = Projection::create("EPSG:25832");
  ASSERT_TRUE(projection);
  const double angle = 3.0 * units::deg, scale = 1.000025;
  const auto wanted = [&](const MapPoint& p) {
    const double e = p.easting - 500000.0, n = p.northing - 5500000.0;
    return MapPoint{1000.0 + scale * (std::cos(angle) * e - std::sin(angle) * n),
                    2000.0 + scale * (std::sin(angle) * e + std::cos(angle) * n), p.height - 45.2};
  };
  std::vector<CommonPoint> points;
  std::vector<HeightPoint> heights;
  const auto place = [](double north, double east) {
    return Geodetic{49.65 * units::deg + north / 6.37e6, 9.0 * units::deg + east / 4.13e6, 100.0};
  };
  for (const auto& [n, e] : {std::pair{0.0, 0.0}, {2000.0, 500.0}, {-500.0, 1500.0}, {900.0, -800.0}}) {
    const MapPoint p = projection->forward(place(n, e)), q = wanted(p);
    points.push_back({"p", {p.easting, p.northing, 0.0}, {q.easting, q.northing, 0.0}});
    heights.push_back({"p", p.easting, p.northing, p.height, q.height});
  }
  const auto similarity = fit_similarity(points);
  const auto datum = HeightDatum::offset(heights);
  ASSERT_TRUE(similarity && datum);
  const ProjectMap map{*projection, *similarity, *datum};
  const Geodetic here = place(300.0, 400.0), north{here.latitude + 1e-6, here.longitude, here.height};
  const MapPoint found = map.forward(here), expected = wanted(projection->forward(here));
  EXPECT_NEAR(found.easting, expected.easting, 1e-6);
  EXPECT_NEAR(found.northing, expected.northing, 1e-6);
  EXPECT_NEAR(found.height, expected.height, 1e-9);
  // Convergence and scale are those of the grid: true north on the map, turned back by it.
  const MapPoint ahead = map.forward(north);
  const auto d = map.distortion(here);
  EXPECT_NEAR(std::atan2(ahead.easting - found.easting, ahead.northing - found.northing), -d.convergence, 1e-6);
  EXPECT_NEAR(d.scale / projection->distortion(here).scale, scale, 1e-9);
}

}  // namespace
}  // namespace versine::geodesy
