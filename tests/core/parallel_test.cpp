// SPDX-License-Identifier: Apache-2.0
#include "versine/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace versine {
namespace {

TEST(Parallel, EveryIndexOnce) {
  for (const std::size_t threads : {0UL, 1UL, 2UL, 7UL, 100UL}) {
    std::vector<std::atomic<int>> calls(50);
    parallel_for(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    for (const auto& c : calls) EXPECT_EQ(c, 1);
  }
  parallel_for(0, 4, [](std::size_t) { FAIL(); });
  EXPECT_GE(thread_count(0), 1U);
  EXPECT_EQ(thread_count(3), 3U);
}

TEST(Parallel, WhatIsThrownComesOutAfterTheOthers) {
  std::atomic<int> done{0};
  const auto work = [&](std::size_t i) {
    if (i == 3) throw std::runtime_error("three");
    ++done;
  };
  EXPECT_THROW(parallel_for(20, 3, work), std::runtime_error);
  EXPECT_EQ(done, 19);
}

}  // namespace
}  // namespace versine
