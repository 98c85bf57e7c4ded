// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "support/shared_data.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/projection.hpp"

/// Real pairs of Belgian Lambert 72 and WGS84 from a measuring train's logs.
namespace versine::geodesy {
namespace {

struct Pair {
  MapPoint map;
  Geodetic place;
};

std::vector<Pair> pairs_of(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  std::vector<Pair> out;
  while (std::getline(stream, line)) {
    std::stringstream cells(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::atof(cell.c_str()));
    out.push_back({{numbers[5], numbers[6], 0.0}, {numbers[7] * units::deg, numbers[8] * units::deg, 0.0}});
  }
  return out;
}

double worst(const Projection& projection, const std::vector<Pair>& pairs) {
  double out = 0.0;
  for (const auto& p : pairs) {
    const auto m = projection.forward(p.place);
    out = std::max(out, std::hypot(m.easting - p.map.easting, m.northing - p.map.northing));
  }
  return out;
}

TEST(Lambert72, AgreesWithTheLogsWithinFiveMillimetres) {
  VERSINE_NEEDS(path, "brussels-airport/log_28876.csv");
  const auto pairs = pairs_of(path);
  ASSERT_GT(pairs.size(), 1000u);
  const auto helmert = Projection::create(
      "+proj=lcc +lat_0=90 +lon_0=4.36748666666667 +lat_1=51.1666672333333 +lat_2=49.8333339 +x_0=150000.013 "
      "+y_0=5400088.438 +ellps=intl +towgs84=-106.8686,52.2978,-103.7239,0.3366,-0.457,1.8422,-1.2747 +units=m "
      "+no_defs");
  ASSERT_TRUE(helmert) << helmert.error().message();
  EXPECT_LT(worst(*helmert, pairs), 0.005);
  // By code PROJ takes the best transformation that it has: within the decimetre that its own database promises.
  const auto code = Projection::create("EPSG:31370");
  ASSERT_TRUE(code) << code.error().message();
  EXPECT_LT(worst(*code, pairs), 0.2);
  const Projection copy = *code;
  EXPECT_EQ(worst(copy, pairs), worst(*code, pairs));
}

}  // namespace
}  // namespace versine::geodesy
