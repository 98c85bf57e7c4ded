// SPDX-License-Identifier: Apache-2.0
#include "versine/app/report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "versine/report/svg.hpp"

namespace versine::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A result folder, written by hand as a survey writes it.
class ReportOfFolder : public ::testing::Test {
 protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      fmt::format("versine_report_test_{}", ::testing::UnitTest::GetInstance()->random_seed());

  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ += info->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void put(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] std::string get(const char* name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  static std::string run(const std::string& results, const std::string& command = "survey",
                         const std::string& settings = R"({"title": "Line 7"})") {
    return R"({"format": "versine run 1", "command": ")" + command + R"(", "version": "0.1.0",
      "started_utc": "2026-11-23T12:00:00Z", "time_scale": "GPS, s since 1980-01-06", "inputs": [{"role": "imu",
      "file": "imu.csv", "bytes": 12, "sha256": "abc"}], "settings": )" +
           settings + R"(, "timings_s": {"read": 0.5}, "results": )" + results +
           R"(, "warnings": ["watch out"], "findings": [], "rejections": [{"sensor": "gnss", "time_s": 5.0,
      "reason": "innovation", "normalized": 7.25, "threshold": 4.0}]})";
  }
  void put_geometry() const {
    std::string csv =
        "distance_m,mileage_m,time_s,flags,easting_axis_m,northing_axis_m,gauge_deviation_mm,"
        "sigma_gauge_deviation_mm\n";
    for (int i = 0; i < 2400; ++i) {
      const double s = 0.25 * i;
      csv += fmt::format("{:.3f},{:.3f},{:.4f},0,{:.4f},{:.4f},", s, 5000.0 + s, s, 500000.0 + s, 5600000.0);
      csv += i > 400 && i < 500 ? ",\n" : fmt::format("{:.3f},0.050\n", i == 1000 ? 4.321 : 0.5 * std::sin(0.05 * i));
    }
    put("geometry.csv", csv);
    put("geometry_columns.csv",
        "# crs: EPSG:25832\ncolumn,unit,sigma,description\neasting_axis_m,m,no,E\nnorthing_axis_m,m,no,N\n"
        "gauge_deviation_mm,mm,yes,\"Gauge, minus nominal\"\n");
    put("run.json", run(R"({"geometry": {"points": 2400, "step_m": 0.25, "crs": "EPSG:25832", "sleepers": 3,
      "height_datum": "ellipsoidal", "conventions": {"vertical": "positive upwards"}}})"));
  }
  [[nodiscard]] std::string refused() const {
    const auto done = write_report(folder_, {});
    return done ? std::string("made a report") : done.error().message();
  }
};

TEST_F(ReportOfFolder, ExtremesAreThoseOfTheFile) {
  put_geometry();
  const auto files = write_report(folder_, {.formats = {"html", "pdf", "xlsx"}});
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(files->size(), 3u);
  const std::string html = get("report.html");
  EXPECT_THAT(html, HasSubstr(">4.32<"));     // largest, in the summary
  EXPECT_THAT(html, HasSubstr(">5+250.0<"));  // where
  EXPECT_THAT(html, HasSubstr(">watch out<"));
  EXPECT_THAT(html, HasSubstr(">7.25<"));
  EXPECT_THAT(html, HasSubstr("Line 7"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".new")));
  }
}

TEST_F(ReportOfFolder, LanguageAndCoverComeFromTheJob) {
  put_geometry();
  put("run.json", run(R"({"geometry": {"points": 2400, "step_m": 0.25}})", "survey",
                      R"({"title": "x", "report": {"language": "de", "formats": ["html"], "line": "6240 Dresden",
                      "operator": "A. Meyer"}})"));
  ASSERT_TRUE(write_report(folder_, {}));
  EXPECT_THAT(get("report.html"), HasSubstr("NICHT BEURTEILT"));
  EXPECT_THAT(get("report.html"), HasSubstr("A. Meyer"));
  EXPECT_THAT(get("report.html"), HasSubstr("6240 Dresden"));
  ASSERT_TRUE(write_report(folder_, {.language = "zh"}));
  EXPECT_THAT(get("report.html"), HasSubstr("未评定"));
}

TEST_F(ReportOfFolder, BadFoldersAreToldWithTheirCure) {
  EXPECT_THAT(refused(), HasSubstr("an empty folder"));
  put("geometry.csv", "x\n");
  EXPECT_THAT(refused(), HasSubstr("without run.json"));
  put("run.json", R"({"format": "versine ru)");
  EXPECT_THAT(refused(), HasSubstr("cut short"));
  put("run.json", R"({"format": "versine run 9"})");
  EXPECT_THAT(refused(), HasSubstr("versine run 9"));
  put("run.json", run(R"({"geometry": "none", "innovations": 7})"));
  EXPECT_THAT(refused(), HasSubstr("of another version"));
  put("run.json", run("{}", "simulate"));
  EXPECT_THAT(refused(), HasSubstr("'simulate'"));
  put_geometry();
  std::filesystem::remove(folder_ / "geometry.csv");
  EXPECT_THAT(refused(), HasSubstr("geometry.csv"));
  put_geometry();
  std::filesystem::remove(folder_ / "geometry_columns.csv");
  EXPECT_THAT(refused(), HasSubstr("geometry_columns.csv"));
  put_geometry();
  put("geometry.csv", get("geometry.csv").substr(0, 5000));
  EXPECT_THAT(refused(), HasSubstr("geometry.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "report.html"));
  EXPECT_THAT(write_report("no such folder", {}).error().message(), HasSubstr("no folder"));
  put_geometry();
  EXPECT_THAT(write_report(folder_, {.formats = {"doc"}}).error().message(), HasSubstr("html, pdf, xlsx"));
  put("run.json", run(R"({"geometry": {"points": 9}})", "survey", R"({"geometry": {"write": {"csv": false}}})"));
  std::filesystem::remove(folder_ / "geometry.csv");
  EXPECT_THAT(refused(), HasSubstr("geometry.write.csv = true"));
}

TEST_F(ReportOfFolder, SurveyWithoutGeometry) {
  put("run.json", run("{}"));
  put("trajectory.csv",
      "# x\ntime_s,latitude_deg,longitude_deg,height_m,easting_m,northing_m,velocity_north_mps,velocity_east_mps,"
      "sigma_north_m,sigma_east_m,sigma_down_m\n"
      "100.0,48,11,500.0,1000,2000,1.0,0.0,0.01,0.01,0.02\n101.0,48,11,500.5,1000,2001,1.0,,0.01,0.01,0.02\n"
      "102.0,48,11,501.0,1000,2002,3.0,4.0,0.01,0.01,0.02\n");
  ASSERT_TRUE(write_report(folder_, {}));
  const std::string html = get("report.html");
  EXPECT_THAT(html, HasSubstr("max 5.00"));  // speed of 3 and 4 m/s
  EXPECT_THAT(html, HasSubstr("max 501.000"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST_F(ReportOfFolder, Georef) {
  put("run.json", run("{}", "georef"));
  EXPECT_THAT(refused(), HasSubstr("georef.json"));
  put("georef.json", R"({"format": "versine-georef 1", "network": {"file": "/a/b/net.geojson", "geojson":
    "network.geojson", "tracks": 2, "warnings": []}, "recordings": [{"name": "log.csv", "findings": [], "journeys": [
    {"journey": 1, "from_s": 10.0, "to_s": 12.0, "length_m": 20.5, "entropy_nat": 0.61, "fixes": 3, "rejected": 1,
     "paths": [{"path": 1, "probability": 0.7, "line": [[4.0, 50.0, 0.0], [4.001, 50.0, 20.5]]},
               {"path": 2, "probability": 0.3, "line": [[4.0, 50.0, 0.0], [4.001, 50.0001, 20.6]]}],
     "switches": [{"time_s": 11.0, "distance_m": 9.0, "from": "A", "to": "B", "probability": 0.7}],
     "ambiguous": [{"from_s": 11.0, "to_s": 12.0, "from_m": 9.0, "to_m": 20.5, "taken": ["B"], "alternative": ["C"],
       "paths": [2], "probability": 0.3, "evidence": {"position": 0.85, "speed": 0, "turn_rate": 0, "route": 0}}]}]},
    {"name": "bad.csv", "error": "it is empty"}]})");
  put("network.geojson",
      R"({"features": [{"geometry": {"type": "LineString", "coordinates": [[4, 50], [4.002, 50]]}}]})");
  put("positions.csv",
      "recording,journey,time_s,speed_mps,sigma_m,sigma_speed_mps\n1,1,10.0,10.0,0.5,0.1\n1,1,11.0,10.0,0.75,0.1\n");
  ASSERT_TRUE(write_report(folder_, {.formats = {"html", "pdf", "xlsx"}}));
  const std::string html = get("report.html");
  for (const char* shown : {">20.500<", ">0.7000<", ">0.3000<", ">0.85<", ">0.750<", ">0.625<", ">max 36.0<",
                            ">it is empty<", ">net.geojson<"}) {
    EXPECT_THAT(html, HasSubstr(shown));
  }
}

}  // namespace
}  // namespace versine::app
