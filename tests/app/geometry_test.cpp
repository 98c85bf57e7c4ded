// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "track/test_run.hpp"
#include "versine/app/measured_axis.hpp"
#include "versine/core/units.hpp"
#include "versine/io/geometry_table.hpp"
#include "versine/io/landxml.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class GeometryJob : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("versine_job_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    track_.lateral = [](double s) { return 0.03 * std::exp(-std::pow((s - 300.0) / 3.0, 2)); };
    track_.vertical = [](double s) { return 0.003 * std::sin(s / 5.0); };
    ASSERT_TRUE(io::write_landxml(folder_ / "line.xml", {&track_.design, 1}));
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_run(const std::string& name, double direction, const geodesy::Euler& mounting) {
    const auto projection = *geodesy::Projection::create("EPSG:25832");
    auto run = track::test::Builder(track_, projection).run(10.0, 600.0, 0.05, direction, direction);
    for (auto& p : run.trajectory.samples) p.q_nb = p.q_nb * geodesy::to_quaternion(mounting);
    run.trajectory.scale = TimeScale::gps;
    for (auto& p : run.trajectory.samples) p.time = p.time + Duration::from_seconds(1.4e9);
    ASSERT_TRUE(io::write_trajectory_csv(folder_ / (name + ".csv"), run.trajectory, {}));
    std::ofstream gauge(folder_ / (name + "_gauge.csv"));
    gauge << "time_s,gauge_mm,temperature_degc\n";
    gauge.precision(15);
    for (const auto& g : run.gauge) gauge << g.time.seconds() + 1.4e9 << ',' << g.reading * 1e3 << ",20\n";
  }
  void write_job(const std::string& text) { std::ofstream(folder_ / "job.toml") << text; }

  fs::path folder_;
  track::test::Track track_;
};

TEST_F(GeometryJob, FromAForeignTrajectoryToEveryFile) {
  write_run("run", 1.0, {});
  write_job(
      "job = 'geometry'\n[trajectory]\nfile = 'run.csv'\n[geometry]\ncrs = 'EPSG:25832'\ndesign = 'line.xml'\n"
      "height_reference = 'axis'\n[geometry.gauge]\nfile = 'run_gauge.csv'\n[geometry.quality]\nspeed_kmh = 160\n"
      "limits = '" +
      std::string(VERSINE_SOURCE_DIR) +
      "/data/limits/en13848-5.toml'\n"
      "[geometry.adjustment]\non = true\n[geometry.write]\ndxf = true\n");
  SilentProgress progress;
  const auto run = run_geometry(folder_ / "job.toml", {}, {}, progress);
  ASSERT_TRUE(run) << run.error().message();
  for (const char* name :
       {"geometry.csv", "geometry_columns.csv", "exceedances.csv", "sections.csv", "result.gpkg", "geometry.xlsx",
        "geometry.dxf", "adjustment.csv", "run.json"}) {
    EXPECT_TRUE(fs::exists(run->folder / name)) << name;
  }
  EXPECT_THAT(run->summary_text, HasSubstr("x IAL"));  // the 30 mm fault
  EXPECT_FALSE(run->acceptable);
}

TEST_F(GeometryJob, AxisIsFittedWhereThereIsNoDesign) {
  write_run("run", 1.0, {});
  write_job("job = 'geometry'\n[trajectory]\nfile = 'run.csv'\n[geometry]\ncrs = 'EPSG:25832'\nfit_axis = true\n");
  SilentProgress progress;
  const auto run = run_geometry(folder_ / "job.toml", {}, {}, progress);
  ASSERT_TRUE(run) << run.error().message();
  EXPECT_TRUE(fs::exists(run->folder / "axis.xml"));
  EXPECT_THAT(run->summary_text, HasSubstr("optimal axis"));
}

TEST_F(GeometryJob, AxisOfAResultIsWrittenWithSigmas) {
  write_run("run", 1.0, {});
  write_job(
      "job = 'geometry'\n[trajectory]\nfile = 'run.csv'\n[geometry]\ncrs = 'EPSG:25832'\n"
      "write = {gpkg = false, xlsx = false}\n");
  SilentProgress progress;
  const auto run = run_geometry(folder_ / "job.toml", {}, {}, progress);
  ASSERT_TRUE(run) << run.error().message();
  const auto axis = run_axis({.result = run->folder, .output = folder_ / "axis.xml"});
  ASSERT_TRUE(axis) << axis.error().message();
  EXPECT_LT(axis->axis.offset_rms, 5e-3);
  ASSERT_FALSE(axis->axis.gradient_sigma.empty());
  EXPECT_GT(axis->axis.gradient_sigma[0].gradient, 0.0);
  const auto back = io::read_landxml(folder_ / "axis.xml");
  ASSERT_TRUE(back) << back.error().message();
  ASSERT_TRUE(back->front().alignment);
  EXPECT_NEAR(back->front().alignment->length(), axis->axis.alignment.length(), 1e-3);
  std::ifstream table(folder_ / "axis.csv");
  EXPECT_NE(std::string(std::istreambuf_iterator<char>(table), {}).find("sigma_radius_m"), std::string::npos);
  EXPECT_FALSE(run_axis({.result = folder_, .output = folder_ / "no.xml"}));
}

TEST_F(GeometryJob, CommonPointsTieTheResultToTheProjectsGrid) {
  write_run("run", 1.0, {});
  // The project's grid is the map shifted by whole kilometres, its heights 40 m lower; one point is 0.3 m off.
  const auto origin = track_.design.at(0.0);
  std::ofstream points(folder_ / "points.csv");
  points.precision(12);
  points << "name,easting_m,northing_m,height_m,project_easting_m,project_northing_m,project_height_m\n";
  for (int k = 0; k < 6; ++k) {
    const double e = origin.easting + 400.0 * k, n = origin.northing + 300.0 * (k % 3);
    points << "P" << k << ',' << e << ',' << n << ",100," << e - 400000.0 + (k == 4 ? 0.3 : 0.0) << ',' << n - 5e6
           << ",60\n";
  }
  points.close();
  const std::string head = "job = 'geometry'\n[trajectory]\nfile = 'run.csv'\n[geometry]\ncrs = 'EPSG:25832'\n";
  const std::string tie = "[geometry.coordinates]\npoints = 'points.csv'\nsimilarity = 'plane'\nheights = 'offset'\n";
  SilentProgress progress;
  write_job(head);
  const auto plain = run_geometry(folder_ / "job.toml", {}, folder_ / "plain", progress);
  ASSERT_TRUE(plain) << plain.error().message();
  write_job(head + tie);
  const auto tied = run_geometry(folder_ / "job.toml", {}, folder_ / "tied", progress);
  ASSERT_TRUE(tied) << tied.error().message();
  EXPECT_THAT(tied->summary_text, HasSubstr("common point P4 does not fit"));
  EXPECT_TRUE(fs::exists(tied->folder / "common_points.csv"));
  const std::vector<std::string> names = {"easting_left_m", "northing_left_m", "height_left_m"};
  const auto a = io::GeometryTable::open(plain->folder / "geometry.csv")->read(names);
  const auto b = io::GeometryTable::open(tied->folder / "geometry.csv")->read(names);
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < (*a)[0].size(); i += 100) {
    EXPECT_NEAR((*a)[0][i] - (*b)[0][i], 400000.0, 2e-3);
    EXPECT_NEAR((*a)[1][i] - (*b)[1][i], 5e6, 2e-3);
    EXPECT_NEAR((*a)[2][i] - (*b)[2][i], 40.0, 1e-3);
  }
  std::ofstream(folder_ / "points.csv")
      << "name,easting_m,northing_m,project_easting_m,project_northing_m\nA,1,2,3,4\n";
  const auto one = run_geometry(folder_ / "job.toml", {}, folder_ / "one", progress);
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().message(), HasSubstr("points.csv"));
  EXPECT_THAT(one.error().message(), HasSubstr("at least 2"));
  EXPECT_FALSE(fs::exists(folder_ / "one"));
}

TEST_F(GeometryJob, CalibrationFindsTheMounting) {
  const geodesy::Euler truth{0.01 * units::deg, -0.02 * units::deg, 0.03 * units::deg};
  write_run("there", 1.0, truth);
  write_run("back", -1.0, truth);
  write_job(
      "job = 'calibrate'\n[[pass]]\nname = 'there'\ntrajectory = {file = 'there.csv'}\n[[pass]]\nname = 'back'\n"
      "trajectory = {file = 'back.csv'}\n[geometry]\ncrs = 'EPSG:25832'\ndesign = 'line.xml'\n");
  SilentProgress progress;
  const auto run = run_calibrate(folder_ / "job.toml", {}, {}, progress);
  ASSERT_TRUE(run) << run.error().message();
  EXPECT_THAT(run->summary_text, HasSubstr("roll        0.010"));
  EXPECT_THAT(run->summary_text, HasSubstr("pitch      -0.0"));
  EXPECT_THAT(run->summary_text, HasSubstr("yaw         0.0300"));
  EXPECT_THAT(run->summary_text, HasSubstr("turned round"));
}

TEST_F(GeometryJob, LimitsAreReadAndBadOnesRefused) {
  for (const char* name : {"en13848-5", "china-ballastless"}) {
    const auto p = read_limits(fs::path(VERSINE_SOURCE_DIR) / "data" / "limits" / (std::string(name) + ".toml"));
    ASSERT_TRUE(p) << p.error().message();
    EXPECT_THAT(p->source, HasSubstr("[M]"));
    EXPECT_GE(p->speeds.size(), 5u);
  }
  std::ofstream(folder_ / "bad.toml")
      << "name='x'\nsource='y'\nlevels=['AL']\n[[speed]]\nmax_kmh=100\n[[speed.limit]]\n"
         "column='gauge'\nlevel='ALL'\nlow=-1\nhigh=1\n";
  EXPECT_FALSE(read_limits(folder_ / "bad.toml"));
}

TEST_F(GeometryJob, MissingTrajectoryAndStrangeDesignAreClearErrors) {
  SilentProgress progress;
  write_job("job = 'geometry'\n[geometry]\n");
  auto run = run_geometry(folder_ / "job.toml", {}, {}, progress);
  ASSERT_FALSE(run);
  EXPECT_THAT(run.error().message(), HasSubstr("trajectory"));
  EXPECT_FALSE(fs::exists(folder_ / "job.result"));
  write_run("run", 1.0, {});
  write_job("job = 'geometry'\n[trajectory]\nfile = 'run.csv'\n[geometry]\ncrs = 'EPSG:25833'\ndesign = 'line.xml'\n");
  run = run_geometry(folder_ / "job.toml", {}, {}, progress);
  ASSERT_FALSE(run);
  EXPECT_THAT(run.error().message(), HasSubstr("contains the run"));
}

}  // namespace
}  // namespace versine::app
