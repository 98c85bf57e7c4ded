// SPDX-License-Identifier: Apache-2.0
#include "versine/network/build.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <numbers>

#include "versine/core/units.hpp"
#include "versine/network/oriented_graph.hpp"
#include "versine/network/path.hpp"

namespace versine::network {
namespace {

using Points = std::vector<Eigen::Vector2d>;

NetworkSource flat(std::vector<std::pair<std::string, Points>> lines) {
  NetworkSource s;
  s.file = "test";
  s.crs = "EPSG:32632";
  for (auto& [id, points] : lines) {
    for (auto& p : points) p += Eigen::Vector2d(500000.0, 5500000.0);  // on the central meridian: scale 0.9996
    s.tracks.push_back({id, points, s.tracks.size() + 1, {}, {}, {}});
  }
  return s;
}

TrackIndex track(const Network& n, const std::string& id) {
  const auto it = std::find_if(n.tracks.begin(), n.tracks.end(), [&](const Track& t) { return t.id == id; });
  if (it == n.tracks.end()) throw std::out_of_range(id);
  return static_cast<TrackIndex>(it - n.tracks.begin());
}

TEST(Build, ASwitchAllowsBothLegsAndNoTurnBetweenThem) {
  const auto n =
      build(flat({{"stem", {{0, 0}, {100, 0}}}, {"main", {{100, 0}, {200, 0}}}, {"leg", {{100, 0}, {200, 11}}}}));
  ASSERT_TRUE(n) << n.error().message();
  const OrientedGraph g(*n);
  const OrientedTrack stem{track(*n, "stem"), false}, main{track(*n, "main"), false}, leg{track(*n, "leg"), false};
  EXPECT_TRUE(g.feasible(stem, main));
  EXPECT_TRUE(g.feasible(stem, leg));
  EXPECT_TRUE(g.feasible(leg.opposite(), stem.opposite()));
  EXPECT_FALSE(g.feasible(leg.opposite(), main));
  EXPECT_FALSE(g.feasible(main.opposite(), leg));
  EXPECT_FALSE(g.successors(stem)[main < leg ? 0 : 1].diverging);
  EXPECT_TRUE(g.successors(stem)[main < leg ? 1 : 0].diverging);
  EXPECT_NEAR(n->tracks[stem.track].line.length(), 100.0 / 0.9996, 1e-3);
}

TEST(Build, ALineThatOthersMeetInsideIsSplitThere) {
  const auto n = build(flat({{"main", {{0, 0}, {200, 0}}}, {"leg", {{80, 0.2}, {180, 10}}}}));
  ASSERT_TRUE(n);
  ASSERT_EQ(n->tracks.size(), 3u);
  EXPECT_EQ(n->tracks[1].id, "main[2]");
  EXPECT_EQ(n->tracks[1].line_id, "main");
  EXPECT_NEAR(n->tracks[1].line_offset, 80.0 / 0.9996, 1e-3);
  const OrientedGraph g(*n);
  EXPECT_TRUE(g.feasible({0, false}, {1, false}));
  EXPECT_TRUE(g.feasible({0, false}, {2, false}));
  EXPECT_FALSE(g.feasible({1, true}, {2, false}));
}

TEST(Build, ALabelledConnectionInsideALine) {
  auto s = flat({{"main", {{0, 0}, {200, 0}}}, {"leg", {{80, 0}, {180, 10}}}});
  SourceConnection c;
  c.a = "leg", c.b = "main", c.at_a = 0.0, c.at_b = 0.4, c.direction_a = -1, c.direction_b = -1;
  s.connections.push_back(c);
  const auto n = build(s);
  ASSERT_TRUE(n);
  ASSERT_EQ(n->tracks.size(), 3u);
  const OrientedGraph g(*n);
  EXPECT_TRUE(g.feasible({2, true}, {0, true}));    // off the leg towards main's beginning
  EXPECT_TRUE(g.feasible({0, false}, {2, false}));  // and the same way back
  EXPECT_TRUE(g.feasible({0, false}, {1, false}));  // straight on
  EXPECT_FALSE(g.feasible({1, true}, {2, false}));
  EXPECT_FALSE(g.feasible({2, true}, {1, false}));
}

TEST(Build, LabelsDecideAgainstAngles) {
  auto s = flat({{"a", {{0, 0}, {100, 0}}}, {"b", {{100, 0}, {200, 0}}}, {"c", {{100, 0}, {200, 11}}}});
  SourceConnection both, none;
  both.a = none.a = "a", both.b = "c", none.b = "b", both.at_a = none.at_a = 1.0;
  none.navigability = Navigability::none;
  s.connections = {both, none};
  const auto n = build(s);
  ASSERT_TRUE(n);
  const OrientedGraph g(*n);
  EXPECT_TRUE(g.feasible({0, false}, {2, false}));
  EXPECT_FALSE(g.feasible({0, false}, {1, false}));
}

TEST(Build, ADiamondCrossingGoesStraightOnASlipAlsoTurns) {
  auto s = flat({{"w", {{-100, 0}, {0, 0}}},
                 {"e", {{0, 0}, {100, 0}}},
                 {"sw", {{-100, -11}, {0, 0}}},
                 {"ne", {{0, 0}, {100, 11}}}});
  s.nodes.push_back({s.tracks[0].points.back(), NodeKind::crossing});
  auto n = build(s);
  ASSERT_TRUE(n);
  EXPECT_EQ(n->connections.size(), 4u);
  s.nodes[0].kind = NodeKind::slip;
  n = build(s);
  EXPECT_EQ(n->connections.size(), 8u);
}

TEST(Build, BadTracksAreNamedAndTheRestIsKept) {
  auto s = flat({{"a", {{0, 0}, {100, 0}}},
                 {"zero", {{5, 5}, {5, 5}}},
                 {"a", {{0, 0}, {100, 0}}},
                 {"a", {{100, 0}, {150, 0}}},
                 {"nan", {{0, 0}, {NAN, 0}}}});
  const auto n = build(s);
  ASSERT_TRUE(n);
  EXPECT_EQ(n->tracks.size(), 2u);
  EXPECT_EQ(n->tracks[1].id, "a#2");
  ASSERT_EQ(n->record.warnings.size(), 4u);
  EXPECT_EQ(n->record.warnings[0], "test: record 2 ('zero'): zero length, left out");
  EXPECT_NE(n->record.warnings[1].find("record 3 ('a'): repeats record 1"), std::string::npos);
}

TEST(Build, DegreesWithAProjectedCrsAndMetresWithoutOneAreRefused) {
  NetworkSource s;
  s.file = "map.shp";
  s.crs = "EPSG:25832";
  s.tracks.push_back({"a", {{9.1, 48.0}, {9.2, 48.1}}, 1, {}, {}, {}});
  auto n = build(s);
  ASSERT_FALSE(n);
  EXPECT_NE(n.error().found.find("look like degrees"), std::string::npos);
  s.crs.clear();
  s.tracks[0].points = {{500000.0, 5500000.0}, {500100.0, 5500000.0}};
  n = build(s);
  ASSERT_FALSE(n);
  EXPECT_EQ(n.error().file, "map.shp");
  EXPECT_EQ(n.error().field, "crs");
}

TEST(Build, LengthsAreThoseOnTheGroundWhereverInTheZone) {
  // Two degrees and more off the central meridian, where the scale changes by 5 ppb a metre.
  auto s = flat({{"a", {{193700, 1200}, {194700, 1200}}}, {"b", {{196100, -2900}, {196100, -2400}}}});
  const auto n = build(s);
  ASSERT_TRUE(n);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& line = n->tracks[i].line;
    const auto from = n->to_geodetic(line.at(End::begin)), to = n->to_geodetic(line.at(End::end));
    double truth = 0.0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude / units::deg, from.longitude / units::deg,
                                             to.latitude / units::deg, to.longitude / units::deg, truth);
    EXPECT_NEAR(line.length() / truth, 1.0, 1e-8) << n->tracks[i].id;
  }
}

TEST(Path, CoordinatesFollowOrientationAndRoundTrip) {
  const auto n = build(flat({{"a", {{100, 0}, {0, 0}}}, {"b", {{100, 0}, {200, 0}, {300, 100}}}}));
  ASSERT_TRUE(n);
  const PathCoordinates p(*n, {{0, true}, {1, false}});
  EXPECT_EQ(first_infeasible(*n, p.path()), 2u);
  EXPECT_NEAR(p.length(), (200.0 + std::sqrt(2.0) * 100.0) / 0.9996, 1e-6);
  for (double d = 0.0; d < p.length(); d += 7.3) {
    const auto back = p.project(p.position(d));
    EXPECT_NEAR(back.distance, d, 1e-6);
    EXPECT_NEAR(back.offset, 0.0, 1e-9);
  }
  EXPECT_NEAR(p.azimuth(50.0, 5.0), 0.5 * std::numbers::pi, 1e-9);
  EXPECT_GT(p.project(p.position(50.0) + Eigen::Vector2d(0, -3)).offset, 2.9);  // right of eastward is south
  const auto at = p.place(30.0);
  EXPECT_EQ(at.track, (OrientedTrack{0, true}));
  EXPECT_NEAR(at.distance, 100.0 / 0.9996 - 30.0, 1e-6);
  EXPECT_NEAR(p.derivative(20.0, 2.0).norm(), 0.9996, 1e-9);
}

}  // namespace
}  // namespace versine::network
