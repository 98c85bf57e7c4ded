// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef_online.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/shared_data.hpp"
#include "versine/app/georef.hpp"

/// The measuring train's logs, replayed: what docs/online.md tells.
namespace versine::app {
namespace {

TEST(OnlineReplay, BrusselsIsNearTheOfflineResultAndHonest) {
  VERSINE_NEEDS(folder, "brussels-airport");
  GeorefConfig config;
  config.network.path = folder / "network_airport.geojson";
  config.network.written = config.network.path.string();
  const auto map = load_map(config);
  ASSERT_TRUE(map) << map.error().message();
  std::size_t legs = 0, wrong = 0, positions = 0;
  for (const char* log : {"log_28573", "log_28876", "log_29083", "log_29304", "log_30908", "log_31241"}) {
    std::vector<Error> faults;
    auto recordings = load_recordings(folder / (std::string(log) + ".csv"), faults);
    ASSERT_TRUE(recordings) << recordings.error().message();
    const auto offline = georef::georeference(**map, recordings->front(), config.options);
    ASSERT_TRUE(offline) << offline.error().message();
    const auto replay = replay_online(**map, recordings->front(), *offline, config.options, config.online);
    fmt::print("{}", online_text(replay));
    EXPECT_GT(replay.same_track, 0.9) << log;
    EXPECT_LT(replay.rms, 3.0) << log;
    EXPECT_GT(replay.coverage, 0.9) << log;
    EXPECT_EQ(replay.restarts, 0u) << log;
    EXPECT_LT(replay.seconds_cpu, 1.0);
    legs += replay.legs, wrong += replay.wrong, positions += replay.positions.size();
  }
  EXPECT_GT(positions, 6000u);
  EXPECT_GT(legs, 15u);
  EXPECT_LE(wrong, 3u);  // in a tunnel of seven minutes
}

}  // namespace
}  // namespace versine::app
