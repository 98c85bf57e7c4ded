// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/journey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "versine/network/build.hpp"
#include "versine/network/oriented_graph.hpp"
#include "versine/simulation/network_layout.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {
namespace {

network::Network made() {
  return std::move(*network::build(make_network({})));
}

TEST(NetworkLayout, IsOneRailwayWithItsSwitches) {
  const auto network = made();
  std::size_t dead_ends = 0, switches = 0;
  for (const auto& joint : network.joints) {
    dead_ends += joint.ends.size() == 1 ? 1 : 0;
    switches += joint.ends.size() == 3 ? 1 : 0;
  }
  // Ends of the double line (4), siding and triangle (2).
  EXPECT_EQ(dead_ends, 6U);
  // Scissors 4, ladders 2 x 4, siding 1, triangle 3.
  EXPECT_EQ(switches, 16U);
}

JourneyScenario harbour() {
  JourneyScenario s;
  s.equipment.imu = ImuModel{.rate = 100.0};
  s.equipment.gnss = GnssModel{};
  // Into the station, back out to the main line, into the triangle and out of its other leg.
  s.stops = {{.track = "A1", .distance = 50.0, .stand = 20.0},
             {.track = "S2", .distance = 200.0, .stand = 30.0},
             {.track = "B1", .distance = 100.0, .speed = 8.0, .stand = 20.0},
             {.track = "S4", .distance = 150.0, .stand = 20.0}};
  return s;
}

TEST(Journey, IsContinuousOverReversals) {
  const auto network = made();
  const auto world = prepare_journey(network, harbour());
  ASSERT_TRUE(world) << world.error().message();
  EXPECT_EQ((*world)->pieces.size(), 3U);
  BodyState before = (*world)->state(0.0);
  for (double t = 0.01; t < (*world)->duration; t += 0.01) {
    const BodyState s = (*world)->state(t);
    EXPECT_LT((s.position - before.position - 0.01 * 0.5 * (s.velocity + before.velocity)).norm(), 2e-5) << t;
    EXPECT_LT((s.C_lb - before.C_lb).norm(), 0.01) << t;
    before = s;
  }
}

TEST(Journey, TruthLiesOnItsTracks) {
  const auto network = made();
  const auto world = prepare_journey(network, harbour());
  ASSERT_TRUE(world) << world.error().message();
  const auto r = observe(**world, 1);
  const network::OrientedGraph graph(network);
  for (std::size_t i = 0; i < r.truth.progress.size(); ++i) {
    const auto& p = r.truth.progress[i];
    const auto track =
        std::find_if(network.tracks.begin(), network.tracks.end(), [&](const auto& t) { return t.id == p.track; });
    ASSERT_NE(track, network.tracks.end()) << p.track;
    const auto at = network.to_map(r.truth.trajectory[i].position);
    EXPECT_LT((at - track->line.position(p.track_distance)).norm(), 0.6) << p.track << " " << p.track_distance;
  }
  const auto& last = r.truth.progress.back();
  EXPECT_EQ(last.track, "S4");
  EXPECT_NEAR(last.track_distance, 150.0, 1e-6);
  EXPECT_EQ(r.gnss.size(), static_cast<std::size_t>((*world)->duration) + 1);
}

TEST(Journey, TurnsInTheTriangle) {
  const auto network = made();
  JourneyScenario s;
  // In by one leg, backwards out by the other: the vehicle then faces the other way on the main line.
  const auto a_pieces = [&] {
    std::string last;
    for (const auto& t : network.tracks) {
      if (t.id.starts_with("A")) last = t.id;
    }
    return last;
  }();
  s.stops = {{.track = "A1", .distance = 50.0},
             {.track = "T", .distance = 150.0},
             {.track = a_pieces, .distance = 200.0},
             {.track = "A1", .distance = 100.0}};
  const auto world = prepare_journey(network, s);
  ASSERT_TRUE(world) << world.error().message();
  const auto forward = [&](double t) { return Eigen::Vector3d((*world)->state(t).C_lb.col(0)); };
  EXPECT_LT(forward(1.0).dot(forward((*world)->duration - 1.0)), -0.99);
}

TEST(Journey, TellsWhatDoesNotGo) {
  const auto network = made();
  JourneyScenario s = harbour();
  s.stops[1].track = "S9";
  auto world = prepare_journey(network, s);
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().field, "journey[1].track");
  s = harbour();
  s.stops[2].distance = 1e5;
  EXPECT_EQ(prepare_journey(network, s).error().field, "journey[2].distance_m");
  // Reversing right behind the switch of the scissors, with the vehicle's tail on it.
  s = harbour();
  s.stops = {
      {.track = "X1ab", .distance = 30.0}, {.track = "B2", .distance = 15.0}, {.track = "B1", .distance = 100.0}};
  EXPECT_FALSE(prepare_journey(network, s));
}

}  // namespace
}  // namespace versine::simulation
