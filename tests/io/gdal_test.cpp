// SPDX-License-Identifier: Apache-2.0
#include "../../src/io/gdal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace versine::io {
namespace {

TEST(Gdal, AMissingLibraryIsNamedWithTheCure) {
  const auto g = load_gdal("libgdal-of-nobody.so.1");
  ASSERT_FALSE(g);
  EXPECT_EQ(g.error().file, "libgdal-of-nobody.so.1");
  EXPECT_THAT(g.error().found, testing::HasSubstr("libgdal-of-nobody.so.1"));
  EXPECT_THAT(g.error().advice, testing::HasSubstr("install"));
}

TEST(Gdal, ALibraryWithoutAFunctionIsNamedWithIt) {
  const auto g = load_gdal("libm.so.6");
  ASSERT_FALSE(g);
  EXPECT_EQ(g.error().found, "no function CPLErrorReset");
}

TEST(Gdal, ManyThreadsMayAskForDriversAtOnce) {
  std::vector<const Gdal*> seen(6, nullptr);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      threads.emplace_back([&, i] {
        const auto g = gdal(i % 3 == 0 ? GdalDrivers::geopackage : i % 3 == 1 ? GdalDrivers::dxf : GdalDrivers::all);
        if (g && (*g)->GDALGetDriverByName(i % 3 == 1 ? "DXF" : "GPKG") != nullptr) seen[i] = *g;
      });
    }
  }
  EXPECT_NE(seen[0], nullptr);
  EXPECT_THAT(seen, testing::Each(seen[0]));
}

}  // namespace
}  // namespace versine::io
