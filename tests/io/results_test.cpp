// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::io {
namespace {
namespace fs = std::filesystem;

class Results : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("versine_results_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  std::string get(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

geodesy::Trajectory example() {
  geodesy::Trajectory t;
  t.scale = TimeScale::gps;
  t.origin = "example";
  for (std::int64_t i = 0; i < 1000; ++i) {
    geodesy::TrajectoryPoint p;
    p.time = {1'436'038'476'000'000'000 + i * 5'000'000};
    p.position = {0.9 + 1e-7 * static_cast<double>(i), -0.2, 420.12345};
    p.v_eb_n = {1.0, -2.0, 0.001 * static_cast<double>(i)};
    p.q_nb = geodesy::to_quaternion({0.01, -0.02, 3.0 + 0.0005 * static_cast<double>(i)});
    p.position_covariance = {.xx = 1e-4f, .yy = 4e-4f, .zz = 9e-4f};
    p.velocity_covariance = {.xx = 1e-6f, .yy = 1e-6f, .zz = 1e-6f};
    p.attitude_covariance = {.xx = 1e-8f, .yy = 1e-8f, .zz = 4e-8f};
    p.segment = static_cast<std::int32_t>(i / 500);
    t.samples.push_back(p);
  }
  return t;
}

void expect_same(const geodesy::Trajectory& a, const geodesy::Trajectory& b, double place) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.scale, b.scale);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_NEAR(a[i].position.latitude, b[i].position.latitude, place / 6.4e6);
    EXPECT_NEAR(a[i].position.longitude, b[i].position.longitude, place / 6.4e6);
    EXPECT_NEAR(a[i].position.height, b[i].position.height, place + 5e-6);
    EXPECT_LT((a[i].v_eb_n - b[i].v_eb_n).norm(), 2e-6);
    EXPECT_LT(a[i].q_nb.angularDistance(b[i].q_nb), 5e-9);
    EXPECT_NEAR(a[i].position_covariance.yy, b[i].position_covariance.yy, 1e-7);
    EXPECT_NEAR(a[i].attitude_covariance.zz, b[i].attitude_covariance.zz, 1e-10);
    EXPECT_EQ(a[i].segment, b[i].segment);
  }
}

TEST_F(Results, TrajectoryCsvRoundTrip) {
  const auto out = example();
  ASSERT_TRUE(write_trajectory_csv(folder_ / "t.csv", out));
  TrajectoryFile file;
  file.table.path = folder_ / "t.csv";
  const auto in = read_trajectory(file);
  ASSERT_TRUE(in) << in.error().message();
  expect_same(out, in->series, 1e-6);
}

TEST_F(Results, TrajectoryHdf5RoundTrip) {
  fusion::Solution solution;
  solution.smoothed = example();
  solution.error_names = {"gyro_bias_x"};
  solution.sensor_errors.push_back(
      {.time = {5}, .value = Eigen::VectorXf::Constant(1, 2.0f), .sigma = Eigen::VectorXf::Constant(1, 1.0f)});
  solution.innovations.push_back(
      {.time = {7}, .sensor = "gnss position", .value = Eigen::VectorXf::Zero(3), .sigma = Eigen::VectorXf::Ones(3)});
  ASSERT_TRUE(write_solution_hdf5(folder_ / "t.h5", solution));
  TrajectoryFile file;
  file.table.path = folder_ / "t.h5";
  const auto in = read_trajectory(file);
  ASSERT_TRUE(in) << in.error().message();
  expect_same(solution.smoothed, in->series, 1e-9);
}

TEST_F(Results, DecimationKeepsFirstPointsOfSegments) {
  auto out = example();
  ASSERT_TRUE(write_trajectory_csv(folder_ / "t.csv", out, {.interval = Duration{200'000'000}}));
  TrajectoryFile file;
  file.table.path = folder_ / "t.csv";
  const auto in = read_trajectory(file);
  ASSERT_TRUE(in);
  EXPECT_EQ(in->series.size(), 26u);  // every 40th of 500, in two segments
  EXPECT_EQ(in->series[13].segment, 1);
}

TEST_F(Results, FolderAppearsWholeAndReplacesTheOld) {
  const fs::path target = folder_ / "result";
  {
    auto folder = ResultFolder::create(target);
    ASSERT_TRUE(folder) << folder.error().message();
    put(folder->path("run.json"), "old");
    put(folder->path("only_old.csv"), "x");
    EXPECT_FALSE(fs::exists(target));
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_EQ(get(target / "run.json"), "old");
  {
    auto abandoned = ResultFolder::create(target);
    ASSERT_TRUE(abandoned);
    put(abandoned->path("run.json"), "abandoned");
  }
  EXPECT_EQ(get(target / "run.json"), "old");
  fs::create_directories(folder_ / ".result.new-999999999");  // what a killed job leaves
  {
    auto folder = ResultFolder::create(target);
    ASSERT_TRUE(folder);
    put(folder->path("run.json"), "new");
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_EQ(get(target / "run.json"), "new");
  EXPECT_FALSE(fs::exists(target / "only_old.csv"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);  // nothing else is left
}

TEST_F(Results, FolderRecoversFromAKillBetweenTwoRenames) {
  fs::create_directories(folder_ / ".result.old-999999999");
  put(folder_ / ".result.old-999999999" / "run.json", "old");
  auto folder = ResultFolder::create(folder_ / "result");
  ASSERT_TRUE(folder);
  EXPECT_EQ(get(folder_ / "result" / "run.json"), "old");
}

TEST_F(Results, FolderRefusesWhatIsNotItsOwn) {
  put(folder_ / "file", "x");
  const auto file = ResultFolder::create(folder_ / "file");
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message().find("--output"), std::string::npos);
  fs::create_directories(folder_ / "photos");
  put(folder_ / "photos" / "a.jpg", "x");
  EXPECT_FALSE(ResultFolder::create(folder_ / "photos"));
  EXPECT_FALSE(ResultFolder::create("/proc/versine-cannot-write/result"));
}

TEST_F(Results, RunJsonIsValidWithAnyContent) {
  put(folder_ / "abc", "abc");
  const auto input = describe_input("imu", "abc", folder_ / "abc");
  ASSERT_TRUE(input);
  EXPECT_EQ(input->sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-2
  EXPECT_EQ(input->bytes, 3u);
  io::Run run;
  run.command = "survey";
  run.inputs = {*input};
  run.settings_json = R"({"a": 1})";
  run.record.warnings = {"broken utf-8 \xff"};
  run.record.rejections.push_back({.sensor = "gnss", .reason = "innovation"});
  run.record.findings.push_back({.sensor = "imu", .kind = "gap", .from = {1}, .to = {2}, .count = 3});
  ASSERT_TRUE(write_run_json(folder_ / "run.json", run));
  const auto json = nlohmann::json::parse(get(folder_ / "run.json"));
  EXPECT_EQ(json["settings"]["a"], 1);
  EXPECT_TRUE(json["rejections"][0]["normalized"].is_null());
  EXPECT_EQ(json["findings"][0]["count"], 3);
  EXPECT_FALSE(describe_input("imu", "x", folder_ / "missing"));
}

}  // namespace
}  // namespace versine::io
