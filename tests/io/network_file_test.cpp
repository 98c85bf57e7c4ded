// SPDX-License-Identifier: Apache-2.0
#include "versine/io/network_file.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "support/shared_data.hpp"
#include "versine/io/journey_onboard.hpp"
#include "versine/network/build.hpp"

namespace versine::io {
namespace {

TEST(NetworkFile, OpenStreetMapExtractLoads) {
  VERSINE_NEEDS(path, "osm-germany/cologne-railway.osm.pbf");
  const auto begin = std::chrono::steady_clock::now();
  const auto source = read_network({.path = path});
  ASSERT_TRUE(source) << source.error().message();
  const auto n = network::build(*source);
  ASSERT_TRUE(n) << n.error().message();
  RecordProperty(
      "milliseconds",
      static_cast<int>(
          std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin).count()));
  EXPECT_GT(source->tracks.size(), 3000u);
  EXPECT_GT(n->tracks.size(), source->tracks.size());
  EXPECT_GT(n->connections.size(), n->tracks.size());
}

TEST(NetworkFile, DegreesWithoutCrsAreNamed) {
  const auto path = std::filesystem::temp_directory_path() / "versine_network_degrees.csv";
  std::ofstream(path) << "id,WKT\n1,\"LINESTRING(9 48,9.1 48.1)\"\n";
  const auto source = read_gdal_network({.path = path});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().file, path.string());
  EXPECT_EQ(source.error().field, "crs") << source.error().message();
  std::filesystem::remove(path);
}

TEST(JourneyOnboard, WhatIsNoHdf5IsNamed) {
  const auto r = read_onboard("/nonexistent.h5");
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().file, "/nonexistent.h5");
}

}  // namespace
}  // namespace versine::io
