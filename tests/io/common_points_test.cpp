// SPDX-License-Identifier: Apache-2.0
#include "versine/io/common_points.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace versine::io {
namespace {

namespace fs = std::filesystem;

Expected<CommonPoints> read(const std::string& text) {
  const fs::path path = fs::temp_directory_path() / "versine_common_points_test.csv";
  std::ofstream(path) << "name,easting_m,northing_m,height_m,project_easting_m,project_northing_m,project_height_m,"
                         "sigma_mm\n"
                      << text;
  TableFile file;
  file.path = path;
  auto out = read_common_points(file);
  fs::remove(path);
  return out;
}

TEST(CommonPoints, PlaneAndHeightPointsAreToldApart) {
  const auto p = read("A,500,600,100,10,20,55,2\nB,700,800,,30,40,,\nC,1,2,101,,,56,\n");
  ASSERT_TRUE(p) << p.error().message();
  ASSERT_EQ(p->plane.size(), 2u);
  ASSERT_EQ(p->height.size(), 2u);
  EXPECT_EQ(p->plane[0].source.z(), 100.0);
  EXPECT_NEAR(p->plane[0].sigma, 2e-3, 1e-12);
  EXPECT_NEAR(p->plane[1].sigma, 1e-3, 1e-12);
  EXPECT_EQ(p->height[1].name, "C");
  EXPECT_EQ(p->height[1].wanted, 56.0);
}

TEST(CommonPoints, HalfAPairIsNamedWithItsLine) {
  const auto p = read("A,500,600,100,10,20,55,2\nB,700,800,,30,,,\n");
  ASSERT_FALSE(p);
  EXPECT_EQ(p.error().line, 3u);
  EXPECT_NE(p.error().message().find("B"), std::string::npos);
}

}  // namespace
}  // namespace versine::io
