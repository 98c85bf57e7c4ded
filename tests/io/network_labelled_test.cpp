// SPDX-License-Identifier: Apache-2.0
#include "versine/io/network_labelled.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "support/shared_data.hpp"
#include "versine/network/build.hpp"
#include "versine/network/oriented_graph.hpp"

namespace versine::io {
namespace {

TEST(NetworkLabelled, BrusselsAnglesAgreeWithTheMapsOwnLabels) {
  VERSINE_NEEDS(path, "brussels-airport/network_airport.geojson");
  auto source = read_labelled_network(path);
  ASSERT_TRUE(source) << source.error().message();
  EXPECT_EQ(source->tracks.size(), 74u);
  EXPECT_EQ(source->connections.size(), 142u);
  const auto labelled = network::build(*source);
  ASSERT_TRUE(labelled) << labelled.error().message();
  EXPECT_EQ(labelled->tracks.size(), 74u);
  EXPECT_TRUE(labelled->record.warnings.empty()) << labelled->record.warnings.front();

  source->connections.clear();
  const auto angles = network::build(*source);
  ASSERT_TRUE(angles);
  const network::OrientedGraph by_label(*labelled);
  std::size_t missed = 0, extra = 0;
  for (const auto& c : labelled->connections) {
    missed += std::none_of(angles->connections.begin(), angles->connections.end(),
                           [&](const auto& d) { return d.from == c.from && d.to == c.to; });
  }
  for (const auto& c : angles->connections) {
    if (by_label.feasible(c.from, c.to)) continue;
    ++extra;  // only where four tracks meet
    EXPECT_EQ(angles->joint(c.from.track, c.from.exit()).ends.size(), 4u) << angles->tracks[c.from.track].id;
  }
  EXPECT_LE(missed / 2, 1u);  // one label allows a turn of more than 30 degrees
  EXPECT_LE(extra / 2, 7u);
}

TEST(NetworkLabelled, DutchBranchesMeetTheNamedPoints) {
  VERSINE_NEEDS(path, "dutch-network/netherlands.geojson.zst");
  const auto source = read_labelled_network(path);
  ASSERT_TRUE(source) << source.error().message();
  EXPECT_EQ(source->crs, "EPSG:28992");
  EXPECT_EQ(source->tracks.size(), 11906u);
  EXPECT_EQ(source->connections.size(), 15289u);
  const auto n = network::build(*source);
  ASSERT_TRUE(n) << n.error().message();
  double length = 0.0;
  for (const auto& t : n->tracks) length += t.line.length();
  EXPECT_NEAR(length, 7214.7e3, 0.001 * 7214.7e3);
  std::size_t far = 0, bent = 0;
  for (const auto& c : n->connections) {
    const auto gap =
        (n->tracks[c.from.track].line.at(c.from.exit()) - n->tracks[c.to.track].line.at(c.to.entry())).norm();
    far += gap > 1.0;
    bent += c.deflection > 0.25 * std::numbers::pi;
  }
  EXPECT_LT(far, n->connections.size() / 1000);
  EXPECT_LT(bent, n->connections.size() / 1000);
}

}  // namespace
}  // namespace versine::io
