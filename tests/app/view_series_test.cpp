// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace versine::app {
namespace {

struct Decoded {
  std::uint32_t n = 0, kind = 0;
  std::vector<double> x;
  std::vector<std::vector<float>> arrays;
};

Decoded decode(const std::string& body) {
  Decoded d;
  std::memcpy(&d.n, body.data(), 4);
  std::memcpy(&d.kind, body.data() + 4, 4);
  d.x.resize(d.n);
  std::memcpy(d.x.data(), body.data() + 8, 8 * d.n);
  const std::size_t arrays[] = {2, 4, 1, 2};
  for (std::size_t k = 0; k < arrays[d.kind]; ++k) {
    d.arrays.emplace_back(d.n);
    std::memcpy(d.arrays.back().data(), body.data() + 8 + 8 * d.n + 4 * d.n * k, 4 * d.n);
  }
  EXPECT_EQ(body.size(), 8 + 8 * d.n + 4 * d.n * arrays[d.kind]);
  return d;
}

ViewSeries wave(std::size_t n, bool with_sigma, std::size_t gap_from = 0, std::size_t gap_to = 0) {
  auto x = std::make_shared<std::vector<double>>();
  std::vector<double> value, sigma;
  for (std::size_t i = 0; i < n; ++i) {
    x->push_back(0.25 * static_cast<double>(i));
    const bool none = i >= gap_from && i < gap_to;
    value.push_back(none ? std::nan("") : std::sin(0.37 * static_cast<double>(i)) * static_cast<double>(i % 97));
    if (with_sigma) sigma.push_back(0.5);
  }
  return {x, value, sigma};
}

TEST(ViewSeries, FewSamplesComeAsTheyAre) {
  const Decoded d = decode(wave(100, true).encode(-1e9, 1e9, 2400));
  EXPECT_EQ(d.kind, 3u);
  ASSERT_EQ(d.n, 100u);
  EXPECT_FLOAT_EQ(d.arrays[0][7], static_cast<float>(std::sin(0.37 * 7) * 7));
  EXPECT_FLOAT_EQ(d.arrays[1][7], 0.5f);
}

TEST(ViewSeries, EveryLevelHoldsTheExtremesOfItsSamples) {
  const ViewSeries series = wave(100'000, true);
  const Decoded all = decode(series.encode(-1e9, 1e9, 0));
  ASSERT_EQ(all.n, 100'000u);
  for (const std::size_t buckets : {2400u, 700u, 30'000u}) {
    const Decoded d = decode(series.encode(-1e9, 1e9, buckets));
    ASSERT_EQ(d.kind, 1u);
    ASSERT_LE(d.n, buckets);
    std::size_t i = 0;
    for (std::size_t k = 0; k < d.n; ++k) {
      float low = 1e30f, high = -1e30f;
      for (; i < all.n && (k + 1 == d.n || all.x[i] < d.x[k + 1]); ++i) {
        low = std::min(low, all.arrays[0][i]);
        high = std::max(high, all.arrays[0][i]);
      }
      ASSERT_EQ(d.arrays[0][k], low);
      ASSERT_EQ(d.arrays[1][k], high);
      ASSERT_FLOAT_EQ(d.arrays[2][k], low - 0.98f);
      ASSERT_FLOAT_EQ(d.arrays[3][k], high + 0.98f);
    }
  }
}

TEST(ViewSeries, AStretchIsAnsweredWithItsNeighbours) {
  const Decoded d = decode(wave(100'000, false).encode(100.1, 100.9, 2400));
  EXPECT_EQ(d.kind, 2u);
  ASSERT_EQ(d.n, 5u);
  EXPECT_DOUBLE_EQ(d.x.front(), 100.0);
  EXPECT_DOUBLE_EQ(d.x.back(), 101.0);
  EXPECT_EQ(decode(wave(10, false).encode(50.0, 60.0, 2400)).n, 1u);
}

TEST(ViewSeries, ABucketIsMissingOnlyWhereAllItsSamplesAre) {
  const Decoded d = decode(wave(10'000, false, 4001, 4999).encode(-1e9, 1e9, 2600));
  ASSERT_EQ(d.n, 2500u);
  EXPECT_FALSE(std::isnan(d.arrays[0][1000]));  // sample 4000 has a value
  EXPECT_TRUE(std::isnan(d.arrays[0][1001]));
  EXPECT_TRUE(std::isnan(d.arrays[0][1248]));
  EXPECT_FALSE(std::isnan(d.arrays[0][1249]));  // as has 4999
}

TEST(ViewSeries, TheNearestSampleIsRead) {
  const ViewSeries series = wave(100, true);
  EXPECT_DOUBLE_EQ(series.at(-5.0)->x, 0.0);
  EXPECT_DOUBLE_EQ(series.at(1.12)->x, 1.0);
  EXPECT_DOUBLE_EQ(series.at(1.13)->x, 1.25);
  EXPECT_DOUBLE_EQ(series.at(1e9)->x, 24.75);
  EXPECT_FLOAT_EQ(series.at(1.0)->sigma, 0.5f);
  EXPECT_FALSE(ViewSeries(std::make_shared<std::vector<double>>(), {}, {}).at(0.0));
}

}  // namespace
}  // namespace versine::app
