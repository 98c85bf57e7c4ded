// SPDX-License-Identifier: Apache-2.0
#include "versine/network/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "versine/network/build.hpp"

namespace versine::network {
namespace {

/// Places count from the middle of the UTM zone.
void add_line(NetworkSource& s, const char* id, std::vector<Eigen::Vector2d> places) {
  for (auto& p : places) p += Eigen::Vector2d(500000.0, 5500000.0);
  s.tracks.push_back({id, std::move(places), 0, {}, {}, {}});
}

TEST(Check, FindsNearMissesIsolatedPiecesAndKinks) {
  NetworkSource s;
  s.crs = "EPSG:32632";
  const auto line = [&](const char* id, std::vector<Eigen::Vector2d> p) { add_line(s, id, std::move(p)); };
  line("stem", {{0, 0}, {100, 0}});
  line("main", {{100.3, 0}, {200, 0}});
  line("leg", {{100, 0}, {200, 11}});
  line("alone", {{0, 500}, {0.09, 500}});
  line("bent", {{200, 0}, {250, 0}, {280, 20}});
  const auto n = build(s);
  ASSERT_TRUE(n);
  const auto c = check(*n);
  EXPECT_EQ(c.switches, 1u);
  EXPECT_EQ(c.pieces, 2u);
  const auto count = [&](const char* kind) {
    return std::count_if(c.findings.begin(), c.findings.end(), [&](const auto& f) { return f.kind == kind; });
  };
  EXPECT_EQ(count("near miss"), 1);
  EXPECT_EQ(count("isolated piece"), 1);
  EXPECT_EQ(count("kink"), 1);
  EXPECT_EQ(count("duplicated track"), 0);
}

TEST(Check, FindsTracksDrawnTwice) {
  NetworkSource s;
  s.crs = "EPSG:32632";
  const auto line = [&](const char* id, std::vector<Eigen::Vector2d> p) { add_line(s, id, std::move(p)); };
  line("a", {{0, 0}, {300, 0}, {600, 20}});
  line("b", {{0, 4}, {300, 4}, {600, 24}});
  line("a again", {{600, 20.2}, {300, 0.2}, {0, 0.2}});
  const auto n = build(s);
  ASSERT_TRUE(n);
  const auto c = check(*n);
  std::vector<std::string> twice;
  for (const auto& f : c.findings) {
    if (f.kind == "duplicated track") twice.push_back(f.track);
  }
  EXPECT_EQ(twice, std::vector<std::string>{"a again"});
}

}  // namespace
}  // namespace versine::network
