// SPDX-License-Identifier: Apache-2.0
// Total stations in whole surveys: simulated recordings through `versine survey`.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "versine/app/compare.hpp"
#include "versine/app/simulate.hpp"
#include "versine/app/survey.hpp"
#include "versine/io/total_station_readings.hpp"
#include "versine/simulation/simulate.hpp"

namespace versine::app {
namespace {
namespace fs = std::filesystem;

/// Five stations on 240 m of track, in a folder of its own, with the job that belongs to it.
struct Recording {
  fs::path folder = fs::temp_directory_path() / (std::string("versine-total-station-survey-") +
                                                 ::testing::UnitTest::GetInstance()->current_test_info()->name());
  simulation::SimulatedRecording truth;

  explicit Recording(std::vector<std::string> more = {}) {
    fs::remove_all(folder);
    const fs::path scenario = fs::path(VERSINE_SOURCE_DIR) / "examples/scenarios/slab-1km.toml";
    more.insert(more.end(),
                {"motion.leg=[{to_m=260.0, speed_kmh=3.6, stop_s=40.0, stop_every_m=60.0, stop_each_s=40.0}]",
                 "total_station.sigma_point_mm=0.5"});
    SilentProgress progress;
    const auto run = run_simulate(scenario, more, folder, 0, 1, progress);
    if (!run) throw std::runtime_error(run.error().message());
    const auto config = read_simulate_config(scenario, more);
    truth = *simulation::simulate(config->scenario, config->seed);
  }
  ~Recording() { fs::remove_all(folder); }

  [[nodiscard]] fs::path job() const { return folder / "survey.toml"; }
  [[nodiscard]] std::string text() const {
    std::ostringstream text;
    text << std::ifstream(job()).rdbuf();
    return text.str();
  }
  [[nodiscard]] SurveyResult survey(const std::vector<std::string>& overrides = {}) const {
    SilentProgress progress;
    SilentLog log;
    const auto config = read_survey_config(job(), overrides);
    if (!config) throw std::runtime_error(config.error().message());
    auto result = compute_survey(*config, job(), progress, log);
    if (!result) throw std::runtime_error(result.error().message());
    return std::move(*result);
  }
  [[nodiscard]] TrajectoryComparison errors(const SurveyResult& r) const {
    return *compare_trajectories(r.estimate.solution.smoothed, truth.truth.trajectory);
  }
};

std::size_t count(const SurveyResult& r, const std::string& sensor, bool used) {
  for (const auto& s : r.estimate.statistics) {
    if (s.sensor == sensor) return used ? s.used : s.rejected;
  }
  return 0;
}

TEST(TotalStationSurvey, PositionsAndReadingsAreOneChangeInTheJob) {
  const Recording recording;
  const auto readings = recording.survey();
  EXPECT_EQ(count(readings, "landmark", true), 5u);
  // The job shows the other way: its [landmarks], written as a comment, in place of [total_station].
  std::string text = recording.text();
  const auto from = text.find("[total_station]"), to = text.find("# [landmarks]");
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  text.erase(from, to - from);
  for (const char* line : {"# [landmarks]", "# file = \"landmarks.csv\"", "# lever_arm_m"}) {
    const auto at = text.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    text.erase(at, 2);
  }
  std::ofstream(recording.job()) << text;
  const auto positions = recording.survey();
  EXPECT_EQ(count(positions, "landmark", true), 5u);
  EXPECT_EQ(count(positions, "landmark attitude", true), 0u);
  for (const auto* r : {&readings, &positions}) {
    const auto e = recording.errors(*r);
    EXPECT_LT(e.across.rms, 1.5e-3);
    EXPECT_LT(e.up.rms, 1.5e-3);
  }
}

TEST(TotalStationSurvey, AttitudeOfTheInstrumentIsUsedWithItsMounting) {
  const Recording recording;
  const auto with = recording.survey();
  EXPECT_EQ(count(with, "landmark attitude", true), 5u);
  EXPECT_EQ(count(with, "landmark attitude", false), 0u);
  const auto& l = with.input.landmarks[2];
  EXPECT_GT(l.position_attitude.norm(), 0.0);
  // Position and attitude together are still a covariance.
  Eigen::Matrix<double, 6, 6> joint;
  joint << l.covariance, l.position_attitude, l.position_attitude.transpose(), l.attitude_covariance;
  EXPECT_EQ(joint.llt().info(), Eigen::Success);
  EXPECT_LT(recording.errors(with).heading.rms, 5.0 * units::arcsec);

  // A mounting that is wrong by a degree costs the attitude, not the survey.
  const auto wrong = recording.survey({"total_station.mounting_deg=[0.3, -0.2, 16.0]"});
  EXPECT_EQ(count(wrong, "landmark attitude", true), 0u);
  EXPECT_EQ(count(wrong, "landmark", true), 5u);
  EXPECT_LT(recording.errors(wrong).across.rms, 1.5e-3);
}

TEST(TotalStationSurvey, MovedControlPointIsNamedByAllTogether) {
  const Recording recording({"total_station.moved_points=1", "total_station.moved_mm=6.0", "seed=3"});
  const auto r = recording.survey({"total_station.check_control=true"});
  ASSERT_TRUE(r.control);
  ASSERT_EQ(recording.truth.truth.moved_points.size(), 1u);
  std::vector<std::string> moved;
  for (const auto& p : r.control->network.points) {
    if (p.moved) moved.push_back(p.name);
  }
  const auto& point = recording.truth.truth.moved_points.front();
  const auto& points = r.control->network.points;
  const bool seen = std::any_of(points.begin(), points.end(), [&](const auto& p) { return p.name == point; });
  EXPECT_EQ(moved, seen ? recording.truth.truth.moved_points : std::vector<std::string>{});
  EXPECT_NEAR(r.control->network.sigma0, 1.0, 0.25);
}

/// A reading without error of an instrument whose circle's zero is north.
stationing::Sighting see(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const std::string& point,
                         stationing::Face face) {
  const Eigen::Vector3d d = to - from;
  const bool two = face == stationing::Face::two;
  stationing::Sighting s{.point = point, .face = face};
  const double zenith = std::acos(-d.z() / d.norm());
  s.direction = std::atan2(d.y(), d.x()) + (two ? std::numbers::pi : 0.0);
  s.zenith = two ? 2.0 * std::numbers::pi - zenith : zenith;
  s.distance = d.norm();
  return s;
}

// The other arrangement: the instrument stands beside the track, finds itself between control points, and watches the
// trolley's prism at every stop.
TEST(TotalStationSurvey, PrismWatchedFromBesideTheTrack) {
  const Recording recording;
  const auto& truth = recording.truth;
  const geodesy::LocalFrame frame(truth.origin);
  const auto place_at = [&](Time t) -> Eigen::Vector3d {
    const auto& p = truth.truth.trajectory[truth.truth.trajectory.lower_bound(t)];
    return frame.to_ned(p.position) + frame.rotation_from(p.position) * (p.q_nb * Eigen::Vector3d(0.0, 0.0, -0.6));
  };
  const auto& stops = truth.truth.standstills;
  const auto middle = stops[stops.size() / 2];
  const Eigen::Vector3d station = place_at(middle.from + Duration::from_seconds(5.0)) + Eigen::Vector3d(2.5, -3.0, 0.2);
  stationing::Stationing s{.name = "T1"};
  using stationing::Face;
  for (const auto& p : truth.control_points) {
    if ((p.position - station).norm() > 110.0) continue;
    for (const Face face : {Face::one, Face::two}) s.sightings.push_back(see(station, p.position, p.name, face));
  }
  int set = 0;
  for (const auto& stop : stops) {
    const Time from = stop.from + Duration::from_seconds(1.0), to = stop.to - Duration::from_seconds(1.0);
    ++set;
    for (const Face face : {Face::one, Face::two}) {
      s.sightings.push_back(see(station, place_at(from + Duration::from_seconds(2.0)), "PRISM", face));
      auto& r = s.sightings.back();
      r.from = from, r.to = to, r.set = set;
    }
  }
  ASSERT_TRUE(io::write_total_station(recording.folder / "readings.csv", std::span(&s, 1)));
  const auto r = recording.survey({"total_station.arrangement=\"beside\"", "total_station.refraction=0.0"});
  EXPECT_EQ(count(r, "landmark", true), stops.size());
  EXPECT_EQ(count(r, "landmark attitude", true), 0u);
  const auto e = recording.errors(r);
  EXPECT_LT(e.across.rms, 1.5e-3);
  EXPECT_LT(e.up.rms, 1.5e-3);
}

TEST(TotalStationSurvey, AStationInMotionIsLeftOut) {
  const Recording recording;
  // Two stations told to last into the ride, after which IMU and odometer say that the trolley moved.
  auto config = read_survey_config(recording.job());
  ASSERT_TRUE(config);
  std::ifstream in(recording.folder / "readings.csv");
  std::string line, text;
  while (std::getline(in, line)) {
    if (line.starts_with("S002,")) {
      const auto a = line.find(',', line.find(',') + 1), b = line.find(',', a + 1), c = line.find(',', b + 1);
      const double to = std::stod(line.substr(b + 1, c - b - 1));
      char later[40];
      std::snprintf(later, sizeof later, "%.3f", to + 20.0);
      line = line.substr(0, b + 1) + later + line.substr(c);
    }
    text += line + "\n";
  }
  std::ofstream(recording.folder / "readings.csv") << text;
  const auto r = recording.survey();
  EXPECT_EQ(count(r, "landmark", true), 4u);
  const auto& rejections = r.input.record.rejections;
  EXPECT_TRUE(std::any_of(rejections.begin(), rejections.end(),
                          [](const auto& x) { return x.reason.find("S002: not standing") != std::string::npos; }));
}

}  // namespace
}  // namespace versine::app
