// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "versine/io/adjustment_csv.hpp"
#include "versine/io/geometry_csv.hpp"
#include "versine/io/geometry_gis.hpp"
#include "versine/io/geometry_table.hpp"
#include "versine/io/geometry_xlsx.hpp"

namespace versine::io {
namespace {

using ::testing::HasSubstr;

/// 100 m with a gap of five metres and one exceedance.
track::Geometry sample_geometry() {
  track::Geometry g;
  g.crs = "EPSG:25832";
  g.height_datum = "ellipsoidal";
  g.conventions = {{"lateral", "positive right"}};
  g.posted = {{0.0, 12000.0}, {50.0, 12040.0}};
  for (int i = 0; i <= 400; ++i) {
    g.mileage.push_back(0.25 * i);
    g.time.push_back(Time::from_seconds(100.0 + i));
    g.flags.push_back(0);
  }
  for (const char* name : {"easting_axis", "northing_axis", "height_axis", "easting_left", "northing_left",
                           "height_left", "easting_right", "northing_right", "height_right"}) {
    g.add(name, "m", 1.0, "");
  }
  g.add("gauge", "mm", 1e-3, "Gauge, with a comma");
  g.add("cross_level", "mm", 1e-3, "");
  for (std::size_t i = 0; i < g.size(); ++i) {
    for (auto& c : g.columns) {
      c.value[i] =
          c.name.starts_with("easting") ? 500000.0 + g.mileage[i] : (c.name.starts_with("northing") ? 5.6e6 : 100.0);
      c.sigma[i] = 0.0005f;
      if (i >= 200 && i < 220) c.value[i] = std::nan("");
    }
    g.find("gauge")->value[i] = 1.435;
    g.find("cross_level")->value[i] = i < 100 ? -0.02 : 0.02;
  }
  return g;
}
track::Quality quality() {
  track::Quality q;
  q.exceedances.push_back({.column = "gauge",
                           .level = "IL",
                           .start = 10,
                           .end = 12,
                           .peak = 11,
                           .value = 1.44,
                           .sigma = 1e-4,
                           .limit = 1.438,
                           .probability = 0.99,
                           .index = 44});
  track::Section s{.start = 0, .end = 100};
  s.sigma = {{"gauge", 0.001}};
  q.sections.push_back(s);
  return q;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class GeometryFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("versine_geometry_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(GeometryFiles, CsvHasUnitsPostedMileageAndEmptyFields) {
  ASSERT_TRUE(write_geometry_csv(folder_ / "g.csv", sample_geometry()));
  ASSERT_TRUE(write_geometry_columns_csv(folder_ / "c.csv", sample_geometry()));
  ASSERT_TRUE(write_exceedances_csv(folder_ / "e.csv", sample_geometry(), quality()));
  ASSERT_TRUE(write_sections_csv(folder_ / "s.csv", sample_geometry(), quality()));
  const std::string g = content(folder_ / "g.csv");
  EXPECT_THAT(g, HasSubstr("gauge_mm,sigma_gauge_mm,cross_level_mm"));
  EXPECT_THAT(g, HasSubstr("\n60.000,12050.000,340.0000,0,500060.0000,0.0005,"));
  EXPECT_THAT(g, HasSubstr("\n50.000,12040.000,300.0000,0,,0.0005,"));
  EXPECT_THAT(content(folder_ / "c.csv"), HasSubstr("gauge_mm,mm,yes,\"Gauge, with a comma\""));
  EXPECT_THAT(content(folder_ / "e.csv"),
              HasSubstr("12010.00,12012.00,12011.00,2.00,gauge,mm,IL,1440.000,0.100,1438.000"));
  EXPECT_FALSE(write_geometry_csv(folder_ / "missing" / "g.csv", sample_geometry()));
}

TEST_F(GeometryFiles, GeoPackageHasItsLayersAndSplitsLinesAtGaps) {
  const auto q = quality();
  ASSERT_TRUE(write_geometry_gpkg(folder_ / "r.gpkg", sample_geometry(), &q));
  GDALDataset* set = GDALDataset::Open((folder_ / "r.gpkg").c_str(), GDAL_OF_VECTOR);
  ASSERT_NE(set, nullptr);
  EXPECT_EQ(set->GetLayerByName("axis")->GetFeatureCount(), 2);
  EXPECT_EQ(set->GetLayerByName("rails")->GetFeatureCount(), 4);
  EXPECT_EQ(set->GetLayerByName("points")->GetFeatureCount(), 96);
  EXPECT_EQ(set->GetLayerByName("exceedances")->GetFeatureCount(), 1);
  OGREnvelope box;
  ASSERT_EQ(set->GetLayerByName("axis")->GetExtent(&box), OGRERR_NONE);
  EXPECT_NEAR(box.MaxX, 500100.0, 1e-6);
  GDALClose(set);
}

TEST_F(GeometryFiles, DxfAndWorkbookAreWritten) {
  const auto q = quality();
  ASSERT_TRUE(write_geometry_dxf(folder_ / "g.dxf", sample_geometry(), &q));
  EXPECT_THAT(content(folder_ / "g.dxf"), HasSubstr("RAIL_LEFT"));
  ASSERT_TRUE(write_geometry_xlsx(folder_ / "g.xlsx", sample_geometry(), &q, nullptr));
  EXPECT_GT(std::filesystem::file_size(folder_ / "g.xlsx"), 5000u);
}

TEST_F(GeometryFiles, AdjustmentTableTakesTheUsersColumnsAndSigns) {
  track::Adjustment slew;
  slew.movement.assign(401, 0.0034);
  slew.after.assign(401, 0.0);
  AdjustmentTable t;
  t.columns = {"mileage_km", "slew_mm", "reference_rail"};
  t.slew_right_positive = false;
  t.delimiter = ";";
  t.decimal_comma = true;
  ASSERT_TRUE(write_adjustment_csv(folder_ / "a.csv", sample_geometry(), &slew, nullptr, t));
  const std::string text = content(folder_ / "a.csv");
  EXPECT_THAT(text, HasSubstr("# slew: movement of the track, positive to the left"));
  EXPECT_THAT(text, HasSubstr("mileage_km;slew_mm;reference_rail\n12,000000;-3,4;left\n"));
  EXPECT_THAT(text, HasSubstr("12,030000;-3,4;right\n"));
  t.columns = {"slw_mm"};
  const auto refused = write_adjustment_csv(folder_ / "a.csv", sample_geometry(), &slew, nullptr, t);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("slew_mm"));
}

TEST_F(GeometryFiles, TableIsReadBackByColumns) {
  const track::Geometry g = sample_geometry();
  ASSERT_TRUE(write_geometry_csv(folder_ / "geometry.csv", g));
  const auto table = GeometryTable::open(folder_ / "geometry.csv");
  ASSERT_TRUE(table) << table.error().message();
  EXPECT_EQ(table->rows(), g.size());
  EXPECT_TRUE(table->has("sigma_gauge_mm"));
  EXPECT_FALSE(table->has("gauge"));
  // Asked for in another order than they stand in.
  const std::vector<std::string> names = {"cross_level_mm", "distance_m", "sigma_gauge_mm", "mileage_m"};
  const auto columns = table->read(names);
  ASSERT_TRUE(columns) << columns.error().message();
  for (std::size_t i = 0; i < g.size(); ++i) {
    EXPECT_NEAR((*columns)[0][i], g.at("cross_level").value[i] * 1e3, 5e-4);
    EXPECT_DOUBLE_EQ((*columns)[1][i], g.mileage[i]);
    EXPECT_NEAR((*columns)[2][i], 0.5, 1e-3);
    EXPECT_DOUBLE_EQ((*columns)[3][i], g.posted_at(g.mileage[i]));
  }
  const auto gap = table->read(std::vector<std::string>{"height_axis_m"});
  ASSERT_TRUE(gap);
  EXPECT_TRUE(std::isnan((*gap)[0][205]));
}

TEST_F(GeometryFiles, TableTellsWhatIsWrong) {
  const auto write = [&](const std::string& text) { std::ofstream(folder_ / "t.csv", std::ios::binary) << text; };
  const auto open = [&] { return GeometryTable::open(folder_ / "t.csv"); };
  EXPECT_FALSE(GeometryTable::open(folder_ / "none.csv"));
  write("");
  EXPECT_FALSE(open());
  write("a,b\n1,2\n");
  EXPECT_THAT(open().error().message(), HasSubstr("does not begin with distance_m"));
  write("distance_m,mileage_m,x\n0,1,2\n1,2,3");
  EXPECT_THAT(open().error().message(), HasSubstr("without its end"));
  write("distance_m,mileage_m,x\n0,1,2\n1,2\n");
  EXPECT_THAT(open()->read(std::vector<std::string>{"x"}).error().message(), HasSubstr(":3: found fewer fields"));
  write("distance_m,mileage_m,x\n0,1,2\n1,2,3.x\n");
  EXPECT_THAT(open()->read(std::vector<std::string>{"x"}).error().message(), HasSubstr("'3.x' is not a number"));
}

}  // namespace
}  // namespace versine::io
