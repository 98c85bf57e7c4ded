// SPDX-License-Identifier: Apache-2.0
#include "versine/app/stationing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "stationing/generator.hpp"
#include "versine/app/positioning_jobs.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/io/total_station_readings.hpp"

namespace versine::app {
namespace {

using namespace stationing::test;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A survey in files: control.csv, readings.csv, job.toml; with known truth.
struct Files {
  fs::path folder = fs::temp_directory_path() / (std::string("versine-stationing-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  geodesy::LocalFrame frame{geodesy::Geodetic{0.85, 0.16, 300.0}};
  std::vector<stationing::ControlPoint> nominal;
  std::vector<Truth> truth;
  std::vector<stationing::Stationing> stationings;

  Files() {
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::mt19937 rng(77);
    nominal = pairs_along(600.0, rng);
    const auto real = real_places(nominal, rng);
    for (double at = 30.0; at < 600.0; at += 60.0) {
      truth.push_back(trolley(at, rng));
      auto s = readings(truth.back(), real, 7, 1, rng);
      s.name = "S" + std::to_string(static_cast<int>(at));
      s.from = Time::from_seconds(1000.0 + at);
      s.to = Time::from_seconds(1030.0 + at);
      stationings.push_back(s);
    }
    write();
  }
  ~Files() { fs::remove_all(folder); }

  void write() const {
    std::vector<io::ControlEntry> entries;
    for (const auto& p : nominal) {
      entries.push_back({p.name, frame.to_geodetic(p.position), Eigen::Vector3d::Constant(control_sigma)});
    }
    ASSERT_TRUE(io::write_control_points(folder / "control.csv", entries));
    ASSERT_TRUE(io::write_total_station(folder / "readings.csv", stationings));
    std::ofstream(folder / "job.toml") << "job = \"stationing\"\n[total_station]\nreadings = [\"readings.csv\"]\n"
                                          "control = [\"control.csv\"]\n[network]\nadjust = true\n";
  }
  [[nodiscard]] StationingProcessing processing() const {
    StationingProcessing p;
    p.readings = {{folder / "readings.csv", "readings.csv"}};
    p.control = {{folder / "control.csv", "control.csv"}};
    return p;
  }
};

Expected<StationingOutcome> process(const StationingProcessing& p) {
  SilentProgress progress;
  SilentLog log;
  return process_stationing(p, progress, log);
}

TEST(Stationing, FromFilesToLandmarks) {
  const Files files;
  StationingProcessing processing = files.processing();
  EXPECT_FALSE(process(processing)->landmarks.front().q_ns);  // of no use to a filter that does not know the mounting
  processing.mounting = Eigen::Vector3d::Zero();
  const auto o = process(processing);
  ASSERT_TRUE(o) << o.error().message();
  ASSERT_EQ(o->landmarks.size(), files.truth.size());
  for (std::size_t i = 0; i < files.truth.size(); ++i) {
    const auto& l = o->landmarks[i];
    EXPECT_LT((files.frame.to_ned(l.position) - files.truth[i].position).norm(), 2e-3);
    EXPECT_EQ(l.from, Time::from_seconds(1030.0 + 60.0 * static_cast<double>(i)));
    EXPECT_NEAR(std::sqrt(l.covariance(0, 0)), 0.25e-3, 0.15e-3);
    ASSERT_TRUE(l.q_ns);
    const Eigen::Quaterniond truth_ns(files.frame.rotation_from(l.position).transpose() *
                                      files.truth[i].q_ms.toRotationMatrix());
    const Eigen::Vector3d error = geodesy::to_rotation_vector(truth_ns * l.q_ns->conjugate());
    EXPECT_LT(error.dot(l.attitude_covariance.llt().solve(error)), 22.0);
  }
}

TEST(Stationing, JobWritesWhatASurveyReads) {
  const Files files;
  SilentProgress progress;
  SilentLog log;
  const auto run = run_stationing(files.folder / "job.toml", {}, files.folder / "result", progress, log);
  ASSERT_TRUE(run) << run.error().message();
  EXPECT_THAT(run->summary_text, HasSubstr("10 stations, 0 failed"));
  for (const char* name : {"landmarks.csv", "stations.csv", "targets.csv", "points.csv", "run.json"}) {
    EXPECT_TRUE(fs::exists(run->folder / name)) << name;
  }
  const auto read = io::read_landmarks({.table = {.path = run->folder / "landmarks.csv"}});
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->series.size(), 10u);
  EXPECT_LT((files.frame.to_ned(read->series[3].position) - files.truth[3].position).norm(), 2e-3);
}

TEST(Stationing, ABadStationIsARejectionAndNotTheEnd) {
  Files files;
  files.stationings[2].sightings.resize(4);  // two targets in two faces
  files.write();
  const auto o = process(files.processing());
  ASSERT_TRUE(o) << o.error().message();
  EXPECT_EQ(o->landmarks.size(), 9u);
  ASSERT_FALSE(o->record.rejections.empty());
  EXPECT_THAT(o->record.rejections[0].reason, HasSubstr("at least 3 targets"));
}

TEST(Stationing, PrismSeenFromBesideTheTrack) {
  Files files;
  std::mt19937 rng(5);
  const Truth station{{200.0, 190.0, -0.6}, geodesy::to_quaternion({.yaw = 0.4})};
  auto s = readings(station, files.nominal, 6, 1, rng);
  std::vector<Eigen::Vector3d> prisms;
  for (int k = 0; k < 4; ++k) {
    const stationing::ControlPoint prism{.name = "PRISM", .position = {190.0 + 5.0 * k, 190.0 + 5.0 * k, -1.2}};
    stationing::Stationing one{.name = "x"};
    sight(one, station, prism, "PRISM", 1, true, {}, rng);
    for (auto& r : one.sightings) {
      r.from = Time::from_seconds(100.0 * k);
      r.to = Time::from_seconds(100.0 * k + 20.0);
      r.set = k + 1;
      s.sightings.push_back(r);
    }
    prisms.push_back(prism.position);
  }
  files.stationings = {s};
  files.write();
  auto p = files.processing();
  p.arrangement = StationingProcessing::Arrangement::beside;
  const auto o = process(p);
  ASSERT_TRUE(o) << o.error().message();
  ASSERT_EQ(o->landmarks.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((files.frame.to_ned(o->landmarks[k].position) - prisms[k]).norm(), 3e-3);
    EXPECT_EQ(o->landmarks[k].from, Time::from_seconds(100.0 * static_cast<double>(k)));
    EXPECT_FALSE(o->landmarks[k].q_ns);
  }
}

TEST(Stationing, LandmarksNeedAStandingTrolley) {
  std::vector<sensors::LandmarkSample> landmarks(2);
  landmarks[0] = {
      .time = Time::from_seconds(15), .from = Time::from_seconds(10), .to = Time::from_seconds(20), .name = "A"};
  landmarks[1] = {
      .time = Time::from_seconds(45), .from = Time::from_seconds(40), .to = Time::from_seconds(50), .name = "B"};
  const auto rejected = require_standstill(
      landmarks, {{Time::from_seconds(9), Time::from_seconds(21)}, {Time::from_seconds(44), Time::from_seconds(47)}});
  ASSERT_EQ(rejected.size(), 1u);
  EXPECT_THAT(rejected[0].reason, HasSubstr("B: not standing"));
  EXPECT_EQ(landmarks.size(), 1u);
}

TEST(Stationing, FromTheInstrumentToTheBody) {
  const Eigen::Quaterniond q_nb = geodesy::to_quaternion({.roll = 0.05, .pitch = -0.02, .yaw = 1.0});
  const Eigen::Quaterniond q_bs = geodesy::to_quaternion({.roll = 0.01, .pitch = 0.02, .yaw = 2.0});
  const Eigen::Vector3d lever(0.3, -0.2, -1.1);
  const geodesy::Geodetic body{0.85, 0.16, 300.0};
  sensors::LandmarkSample l{.position = geodesy::wgs84.displaced(body, q_nb * lever), .q_ns = q_nb * q_bs};
  l.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  l.attitude_covariance = 1e-10 * Eigen::Matrix3d::Identity();
  const BodyPose b = to_body(l, lever, q_bs, 1e-4, 1e-5);
  EXPECT_LT(geodesy::wgs84.ned_difference(body, b.position).norm(), 1e-6);
  EXPECT_LT(geodesy::to_rotation_vector(b.q_nb * q_nb.conjugate()).norm(), 1e-12);
  EXPECT_GT(b.covariance(0, 0), 2e-8);
}

TEST(Stationing, RefusesWithTheCure) {
  const Files files;
  auto p = files.processing();
  p.control.clear();
  EXPECT_THAT(process(p).error().message(), HasSubstr("no control points"));
  std::ofstream(files.folder / "deg.csv") << "station,point,direction,zenith,distance_m\nA,1,0,90,10\n";
  p = files.processing();
  p.readings = {{files.folder / "deg.csv", "deg.csv"}};
  EXPECT_THAT(process(p).error().message(), HasSubstr("direction"));
  std::ofstream(files.folder / "face.csv")
      << "station,point,direction_gon,zenith_gon,distance_m,face\nA,CP1,0,100,10,2\n";
  p.readings = {{files.folder / "face.csv", "face.csv"}};
  EXPECT_THAT(process(p).error().message(), HasSubstr("in face 2"));
}

TEST(ControlPoints, LandXml) {
  const fs::path path = fs::temp_directory_path() / "versine-cgpoints.xml";
  std::ofstream(path) << "<?xml version=\"1.0\"?><LandXML><CgPoints><CgPoint name=\"A1\">5300000.125 500100.5 "
                         "310.25</CgPoint></CgPoints></LandXML>";
  EXPECT_THAT(io::read_control_points({.table = {.path = path}}).error().message(), HasSubstr("crs"));
  const auto list = io::read_control_points({.table = {.path = path}, .frame = {.crs = "EPSG:25832"}});
  ASSERT_TRUE(list) << list.error().message();
  EXPECT_EQ(list->at(0).name, "A1");
  EXPECT_NEAR(list->at(0).position.height, 310.25, 1e-9);
  EXPECT_NEAR(list->at(0).position.longitude / units::deg, 9.0013, 0.001);
  fs::remove(path);
}

}  // namespace
}  // namespace versine::app
