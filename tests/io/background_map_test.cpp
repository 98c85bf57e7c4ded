// SPDX-License-Identifier: Apache-2.0
#include "versine/io/background_map.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace versine::io {
namespace {

namespace fs = std::filesystem;

/// RGB pictures: left half red, right half blue.
class BackgroundMapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    GDALAllRegister();
    folder = fs::temp_directory_path() / ("versine-background-" + std::to_string(::getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  /// 200 x 100 pixels of `metre` from a place in a CRS; without a place when the CRS is empty.
  fs::path tiff(const char* name, int epsg, double easting, double northing, double metre) {
    const fs::path path = folder / name;
    GDALDataset* set = driver("GTiff")->Create(path.c_str(), 200, 100, 3, GDT_Byte, nullptr);
    paint(set);
    if (epsg != 0) {
      double transform[6] = {easting, metre, 0, northing, 0, -metre};
      set->SetGeoTransform(transform);
      OGRSpatialReference crs;
      crs.importFromEPSG(epsg);
      set->SetSpatialRef(&crs);
    }
    GDALClose(set);
    return path;
  }
  static GDALDriver* driver(const char* name) { return GetGDALDriverManager()->GetDriverByName(name); }
  static void paint(GDALDataset* set) {
    std::vector<unsigned char> row(200);
    for (int band = 1; band <= 3; ++band) {
      for (int x = 0; x < 200; ++x) row[std::size_t(x)] = (band == 1 && x < 100) || (band == 3 && x >= 100) ? 255 : 0;
      for (int y = 0; y < 100; ++y) {
        EXPECT_EQ(set->GetRasterBand(band)->RasterIO(GF_Write, 0, y, 200, 1, row.data(), 200, 1, GDT_Byte, 0, 0),
                  CE_None);
      }
    }
  }
  /// Red, green, blue, alpha of a pixel.
  static std::array<int, 4> pixel(const std::string& png, int x, int y) {
    std::string bytes = png;
    VSIFCloseL(VSIFileFromMemBuffer("/vsimem/read.png", reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE));
    auto* set = GDALDataset::Open("/vsimem/read.png");
    std::array<int, 4> out{-1, -1, -1, -1};
    for (int band = 1; set != nullptr && band <= set->GetRasterCount(); ++band) {
      unsigned char value = 0;
      EXPECT_EQ(set->GetRasterBand(band)->RasterIO(GF_Read, x, y, 1, 1, &value, 1, 1, GDT_Byte, 0, 0), CE_None);
      out[std::size_t(band - 1)] = value;
    }
    if (set != nullptr) GDALClose(set);
    VSIUnlink("/vsimem/read.png");
    return out;
  }
  fs::path folder;
};

constexpr std::array<int, 4> red{255, 0, 0, 255}, blue{0, 0, 255, 255};

TEST_F(BackgroundMapTest, GeoTiffInItsOwnCrsAndInAnother) {
  const auto map = BackgroundMap::open(tiff("a.tif", 25832, 500000, 5600100, 1.0));
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->name(), "a.tif");
  const auto same = map->png("EPSG:25832", {500000, 5600000, 500200, 5600100}, 200, 100);
  ASSERT_TRUE(same) << same.error().message();
  EXPECT_EQ(pixel(*same, 20, 50), red);
  EXPECT_EQ(pixel(*same, 180, 50), blue);
  // Twice the window: transparent where the picture does not reach.
  const auto wide = map->png("EPSG:25832", {500000, 5600000, 500400, 5600100}, 200, 100);
  EXPECT_EQ(pixel(*wide, 40, 50), red);
  EXPECT_EQ(pixel(*wide, 90, 50), blue);
  EXPECT_EQ(pixel(*wide, 150, 50)[3], 0);
  // A project's own false easting: the same picture 100 km further east.
  const auto other = map->png("+proj=tmerc +lat_0=0 +lon_0=9 +k=0.9996 +x_0=600000 +y_0=0 +ellps=GRS80 +units=m",
                              {600000, 5600000, 600200, 5600100}, 200, 100);
  ASSERT_TRUE(other) << other.error().message();
  EXPECT_EQ(pixel(*other, 20, 50), red);
  EXPECT_EQ(pixel(*other, 180, 50), blue);
}

TEST_F(BackgroundMapTest, MbtilesInAProjectCrs) {
  // 200 x 100 pixels of Web Mercator around 9 E 50.55 N at the zoom whose pixels are 2.39 m there.
  const double metre = 156543.033928 / 65536;
  const fs::path mercator = tiff("m.tif", 3857, 1001875.4 - 100 * metre, 6549000 + 50 * metre, metre);
  GDALDataset* set = GDALDataset::Open(mercator.c_str());
  const fs::path tiles = folder / "m.mbtiles";
  GDALDataset* made = driver("MBTiles")->CreateCopy(tiles.c_str(), set, FALSE, nullptr, nullptr, nullptr);
  ASSERT_NE(made, nullptr);
  GDALClose(made);
  GDALClose(set);
  const auto map = BackgroundMap::open(tiles);
  ASSERT_TRUE(map) << map.error().message();
  OGRSpatialReference from, to;
  from.importFromEPSG(3857);
  to.importFromEPSG(25832);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transform(OGRCreateCoordinateTransformation(&from, &to));
  double x = 1001875.4, y = 6549000;
  ASSERT_TRUE(transform->Transform(1, &x, &y));
  const auto png = map->png("EPSG:25832", {x - 50, y - 25, x + 50, y + 25}, 100, 50);
  ASSERT_TRUE(png) << png.error().message();
  const auto left = pixel(*png, 10, 25), right = pixel(*png, 90, 25);
  EXPECT_GT(left[0], 200);
  EXPECT_LT(left[2], 60);
  EXPECT_LT(right[0], 60);
  EXPECT_GT(right[2], 200);
}

TEST_F(BackgroundMapTest, WhatIsNoMapIsRefusedWithTheCure) {
  const auto message = [](const fs::path& path) {
    const auto map = BackgroundMap::open(path);
    return map ? std::string("opened") : map.error().message();
  };
  EXPECT_NE(message(folder / "none.tif").find("no such file"), std::string::npos);
  std::ofstream(folder / "text.tif") << "no picture at all";
  EXPECT_NE(message(folder / "text.tif").find("no picture"), std::string::npos);
  EXPECT_NE(message(tiff("nowhere.tif", 0, 0, 0, 1)).find("does not say where it lies"), std::string::npos);
  std::ofstream(folder / "lines.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[9,50]}}]})";
  EXPECT_NE(message(folder / "lines.geojson").find("a map of lines"), std::string::npos);
  const auto map = BackgroundMap::open(tiff("a.tif", 25832, 500000, 5600100, 1.0));
  ASSERT_TRUE(map);
  const auto wrong = map->png("EPSG:1", {0, 0, 1, 1}, 10, 10);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message().find("a.tif"), std::string::npos);
}

}  // namespace
}  // namespace versine::io
