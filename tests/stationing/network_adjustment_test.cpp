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
  // Half a millimetre in itself, ten metres as a whole.
  StationFigure figure;
  const auto n = static_cast<Eigen::Index>(3 * s.stations.size());
  figure.covariance = 0.25e-6 * Eigen::MatrixXd::Identity(n, n);
  for (std::size_t i = 0; i < s.stations.size(); ++i) {
    figure.stations.push_back(s.stations[i].name);
    figure.positions.push_back(s.truth[i].position + Eigen::Vector3d(7.0, -3.0, 2.0));
    for (std::size_t k = 0; k < s.stations.size(); ++k) {
      figure.covariance.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * k)) +=
          100.0 * Eigen::Matrix3d::Identity();
    }
  }
  const auto joined = adjust_network(s.stations, control, Instrument{}, {}, std::span(&figure, 1));
  ASSERT_TRUE(alone && joined);
  EXPECT_LT(joined->stations.back().covariance(1, 1), 0.5 * alone->stations.back().covariance(1, 1));
  const Eigen::Vector3d e = joined->stations.back().position - s.truth.back().position;
  EXPECT_LT(e.dot(joined->stations.back().covariance.topLeftCorner<3, 3>().llt().solve(e)), 16.3);
  figure.stations[0] = "nowhere";
  EXPECT_FALSE(adjust_network(s.stations, control, Instrument{}, {}, std::span(&figure, 1)));
}

// A control point that only one station sees: its own readings cannot tell a blunder from a movement of the point, the
// figure of the stations tells that the station is where it should be.
TEST(NetworkAdjustment, ATrajectoryTellsOfAPointThatHasMoved) {
  std::size_t found = 0, found_alone = 0, wrong = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Survey s = make_survey(2000 + seed, {4e-3, 4e-3, -3e-3});
    for (auto& station : s.stations) station.targets.resize(4);  // two pairs each: little redundancy
    StationFigure figure;
    std::mt19937 rng(seed);
    std::normal_distribution<double> normal;
    const auto n = static_cast<Eigen::Index>(3 * s.stations.size());
    figure.covariance = 0.04e-6 * Eigen::MatrixXd::Identity(n, n);
    for (std::size_t i = 0; i < s.stations.size(); ++i) {
      figure.stations.push_back(s.stations[i].name);
      figure.positions.push_back(s.truth[i].position + 0.2e-3 * Eigen::Vector3d(normal(rng), normal(rng), normal(rng)));
      for (std::size_t k = 0; k < s.stations.size(); ++k) {
        figure.covariance.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * k)) +=
            1e-2 * Eigen::Matrix3d::Identity();
      }
    }
    const auto control = *ControlNetwork::create(s.nominal);
    const auto alone = adjust_network(s.stations, control, Instrument{}, {});
    const auto joined = adjust_network(s.stations, control, Instrument{}, {}, std::span(&figure, 1));
    ASSERT_TRUE(alone && joined);
    for (const auto& p : joined->points) p.moved ? (p.name == s.nominal[7].name ? ++found : ++wrong) : 0;
    for (const auto& p : alone->points) found_alone += p.moved && p.name == s.nominal[7].name;
  }
  std::printf("moved point found in %zu of 10 with the trajectory, %zu without; %zu others\n", found, found_alone,
              wrong);
  EXPECT_GE(found, 9u);
  EXPECT_LE(wrong, 1u);
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
