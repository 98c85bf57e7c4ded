// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/network_adjustment.hpp"

#include <gtest/gtest.h>

#include "generator.hpp"

namespace versine::stationing {
namespace {

using namespace test;

struct Survey {
  std::vector<ControlPoint> nominal, real;
  std::vector<Truth> truth;
  std::vector<ReducedStation> stations;
};

Survey make_survey(unsigned seed, const Eigen::Vector3d& moved = Eigen::Vector3d::Zero()) {
  std::mt19937 rng(seed);
  Survey s;
  s.nominal = pairs_along(480.0, rng);
  s.real = real_places(s.nominal, rng);
  s.real[7].position += moved;
  for (double at = 30.0; at < 480.0; at += 60.0) {
    s.truth.push_back(trolley(at, rng));
    auto r = readings(s.truth.back(), s.real, 8, 1, rng);
    r.name = "S" + std::to_string(int(at));
    s.stations.push_back(*reduce(r, Instrument{}));
  }
  return s;
}

TEST(NetworkAdjustment, ConstrainedIsAccurateAndHonest) {
  int inside = 0, total = 0;
  double sigma0 = 0.0, station_squares = 0.0;
  const int runs = 60;
  for (int k = 0; k < runs; ++k) {
    const Survey s = make_survey(100 + k);
    const auto net = adjust_network(s.stations, *ControlNetwork::create(s.nominal), Instrument{}, {.snoop = false});
    ASSERT_TRUE(net) << net.error().message();
    sigma0 += net->sigma0 * net->sigma0 / runs;
    for (std::size_t i = 0; i < s.truth.size(); ++i) {
      const Eigen::Vector3d e = net->stations[i].position - s.truth[i].position;
      inside += e.dot(net->stations[i].covariance.topLeftCorner<3, 3>().llt().solve(e)) < 7.815;
      station_squares += e.squaredNorm();
      ++total;
    }
  }
  std::printf("network: sigma0 %.3f, stations inside 95 %% ellipsoid %.3f, rms %.3f mm per axis\n", std::sqrt(sigma0),
              inside / double(total), 1e3 * std::sqrt(station_squares / (3.0 * total)));
  EXPECT_NEAR(std::sqrt(sigma0), 1.0, 0.03);
  EXPECT_NEAR(inside / double(total), 0.95, 0.03);
}

TEST(NetworkAdjustment, NamesTheMovedControlPoint) {
  const Eigen::Vector3d moved(3e-3, -3e-3, 2e-3);
  int found = 0, wrong = 0;
  for (int k = 0; k < 30; ++k) {
    const Survey s = make_survey(500 + k, moved);
    const auto net = adjust_network(s.stations, *ControlNetwork::create(s.nominal), Instrument{}, {});
    ASSERT_TRUE(net) << net.error().message();
    for (const auto& p : net->points) {
      if (!p.moved) continue;
      if (p.name != s.nominal[7].name) {
        ++wrong;
        continue;
      }
      ++found;
      EXPECT_LT((*p.offset - moved).norm(), 2.5e-3);
    }
  }
  EXPECT_EQ(found, 30);
  EXPECT_LE(wrong, 1);
}

TEST(NetworkAdjustment, FreeKnowsTheShapeOnly) {
  const Survey s = make_survey(900);
  const auto free = adjust_network(s.stations, *ControlNetwork::create(s.nominal), Instrument{}, {.free = true});
  ASSERT_TRUE(free) << free.error().message();
  EXPECT_NEAR(free->sigma0, 1.0, 0.25);
  const auto unknown = adjust_network(s.stations, {}, Instrument{}, {.free = true});
  ASSERT_TRUE(unknown) << unknown.error().message();
  EXPECT_NEAR(unknown->sigma0, free->sigma0, 1e-4);
  EXPECT_EQ(unknown->redundancy, free->redundancy);
  // Distances between points do not depend on the datum.
  const auto distance = [](const NetworkResult& n) { return (n.points[1].position - n.points[9].position).norm(); };
  EXPECT_NEAR(distance(*unknown), distance(*free), 1e-6);
}

TEST(NetworkAdjustment, ATrajectoryJoinsWhatPointsDoNot) {
  Survey s = make_survey(901);
  std::vector<ControlPoint> one_end(s.nominal.begin(), s.nominal.begin() + 6);
  const auto control = *ControlNetwork::create(one_end);
  const auto alone = adjust_network(s.stations, control, Instrument{}, {});
  std::vector<RelativePosition> relative;
  for (std::size_t i = 1; i < s.stations.size(); ++i) {
    relative.push_back({s.stations[0].name, s.stations[i].name, s.truth[i].position - s.truth[0].position,
                        1e-6 * Eigen::Matrix3d::Identity()});
  }
  const auto joined = adjust_network(s.stations, control, Instrument{}, {}, relative);
  ASSERT_TRUE(alone && joined);
  EXPECT_LT(joined->stations.back().covariance(1, 1), 0.5 * alone->stations.back().covariance(1, 1));
  relative[0].to = "nowhere";
  EXPECT_FALSE(adjust_network(s.stations, control, Instrument{}, {}, relative));
}

TEST(NetworkAdjustment, RefusesANetworkThatFallsApart) {
  Survey s = make_survey(902);
  for (auto& t : s.stations.back().targets) t.point += "x";
  const auto net = adjust_network(s.stations, *ControlNetwork::create(s.nominal), Instrument{}, {});
  ASSERT_FALSE(net);
  EXPECT_NE(net.error().message().find("too few common points"), std::string::npos);
}

}  // namespace
}  // namespace versine::stationing
