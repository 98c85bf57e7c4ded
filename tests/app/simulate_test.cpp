// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "support/shared_data.hpp"
#include "versine/io/network_file.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/network/build.hpp"
#include "versine/network/oriented_graph.hpp"
#include "versine/simulation/journey.hpp"
#include "versine/simulation/simulate.hpp"

namespace versine::app {
namespace {
namespace fs = std::filesystem;

const fs::path scenarios = fs::path(VERSINE_SOURCE_DIR) / "examples" / "scenarios";

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The error of slab-1km with one text replaced by another.
Error error_with(const std::string& from, const std::string& to) {
  std::string text = text_of(scenarios / "slab-1km.toml");
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const fs::path path = fs::path(testing::TempDir()) / "versine_bad_scenario.toml";
  std::ofstream(path) << text;
  const auto config = read_simulate_config(path);
  fs::remove(path);
  EXPECT_FALSE(config) << to;
  return config ? Error{} : config.error();
}

TEST(SimulateConfig, BadScenariosAreToldWithKeyAndCure) {
  struct Bad {
    const char *from, *to, *key;
  };
  for (const Bad& bad :
       {Bad{"radius_m = 3000.0", "radius_m = -3000.0", "track.horizontal[2].radius_m"},
        Bad{"type = \"clothoid\"", "type = \"clothoid\"\nend_radius_m = 2000.0", "track.horizontal[1].end_radius_m"},
        Bad{"cant_mm = 80.0", "cant_mm = 200.0", "track.cant[1].cant_mm"},
        Bad{"speed_kmh = 3.6", "speed_kmh = 0.0", "motion.leg[0].speed_kmh"},
        Bad{"to_m = 1020.0", "to_m = 2020.0", "motion.leg[0].to_m"},
        Bad{"navigation-rlg", "navigation-rgl", "imu.grade"}, Bad{"stand_s", "stnad_s", "motion.stnad_s"}}) {
    const Error error = error_with(bad.from, bad.to);
    EXPECT_EQ(error.field, bad.key);
    EXPECT_FALSE(error.file.empty());
    EXPECT_FALSE(error.advice.empty() && error.expected.empty()) << bad.to;
  }
}

TEST(SimulateConfig, EveryExampleIsAGoodScenario) {
  for (const auto& entry : fs::directory_iterator(scenarios)) {
    if (entry.path().extension() != ".toml") continue;
    const auto config = read_simulate_config(entry.path());
    EXPECT_TRUE(config) << config.error().message();
  }
}

TEST(Simulate, WritesWhatTheReadersRead) {
  const fs::path folder = fs::path(testing::TempDir()) / "versine_simulate_test";
  SilentProgress progress;
  const std::vector<std::string> shorter{"motion.stand_s=20", "motion.leg=[{to_m=150.0, speed_kmh=7.2, stop_s=20.0}]",
                                         "gnss.rate_hz=1.0"};
  const auto run = run_simulate(scenarios / "slab-1km.toml", shorter, folder, 0, 1, progress);
  ASSERT_TRUE(run) << run.error().message();
  const auto config = read_simulate_config(scenarios / "slab-1km.toml", shorter);
  ASSERT_TRUE(config) << config.error().message();
  const auto made = simulation::simulate(config->scenario, 1);
  ASSERT_TRUE(made) << made.error().message();

  io::ImuFile imu;
  imu.table.path = folder / "imu.csv";
  const auto read = io::read_imu(imu);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->series.size(), made->imu.size());
  EXPECT_EQ(read->series[777].time, made->imu[777].time);
  EXPECT_NEAR((read->series[777].dvel - made->imu[777].dvel).norm(), 0.0, 1e-12);

  io::GnssFile gnss;
  gnss.table.path = folder / "gnss.csv";
  const auto positions = io::read_gnss(gnss);
  ASSERT_TRUE(positions) << positions.error().message();
  EXPECT_EQ(positions->series.size(), made->gnss.size());
  EXPECT_EQ(positions->series[5].fix, made->gnss[5].fix);

  io::LandmarkFile landmarks;
  landmarks.table.path = folder / "landmarks.csv";
  const auto marks = io::read_landmarks(landmarks);
  ASSERT_TRUE(marks) << marks.error().message();
  EXPECT_EQ(marks->series.size(), made->landmarks.size());

  io::TrajectoryFile truth;
  truth.table.path = folder / "truth.h5";
  const auto trajectory = io::read_trajectory(truth);
  ASSERT_TRUE(trajectory) << trajectory.error().message();
  ASSERT_EQ(trajectory->series.size(), made->truth.trajectory.size());
  EXPECT_NEAR(trajectory->series[100].position.height, made->truth.trajectory[100].position.height, 1e-9);
  EXPECT_TRUE(fs::exists(folder / "survey.toml"));
  fs::remove_all(folder);
}

/// Drives straight on for at least 3 km from the middle of the first track where that goes; checks truth against the
/// map.
void drive_on(const fs::path& file) {
  const auto source = io::read_network({.path = file});
  ASSERT_TRUE(source) << source.error().message();
  const auto network = network::build(*source);
  ASSERT_TRUE(network) << network.error().message();
  const network::OrientedGraph graph(*network);
  for (std::uint32_t state = 0; state < graph.states(); ++state) {
    network::Path path{network::OrientedTrack::from_state(state)};
    double length = 0.0;
    for (auto arcs = graph.successors(path.back()); !arcs.empty() && length < 3000.0;
         arcs = graph.successors(path.back())) {
      path.push_back(arcs.front().to);
      length += graph.length(path.back());
    }
    if (length < 3000.0) continue;
    const auto middle = [&](network::OrientedTrack t) {
      return simulation::JourneyStop{.track = network->tracks[t.track].id,
                                     .distance = 0.5 * network->tracks[t.track].line.length(),
                                     .speed = 20.0};
    };
    simulation::JourneyScenario scenario;
    scenario.stops = {middle(path.front()), middle(path.back())};
    const auto world = simulation::prepare_journey(*network, scenario);
    ASSERT_TRUE(world) << world.error().message();
    const auto recording = simulation::observe(**world, 1);
    double worst = 0.0;
    for (std::size_t i = 0; i < recording.truth.progress.size(); ++i) {
      const auto& p = recording.truth.progress[i];
      const auto track =
          std::find_if(network->tracks.begin(), network->tracks.end(), [&](const auto& t) { return t.id == p.track; });
      ASSERT_NE(track, network->tracks.end());
      const auto at = network->to_map(recording.truth.trajectory[i].position);
      worst = std::max(worst, (at - track->line.position(p.track_distance)).norm());
    }
    EXPECT_LT(worst, 1.5) << "m from the map";
    return;
  }
  FAIL() << "no way of 3 km";
}

TEST(SimulatedJourney, DrivesOnTheBrusselsNetwork) {
  VERSINE_NEEDS(file, "brussels-airport/network_airport.geojson");
  drive_on(file);
}

TEST(SimulatedJourney, DrivesOnTheDutchNetwork) {
  VERSINE_NEEDS(file, "dutch-network/subset_utrecht.geojson.zst");
  drive_on(file);
}

}  // namespace
}  // namespace versine::app
