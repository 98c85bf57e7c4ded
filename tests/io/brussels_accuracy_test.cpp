// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/brussels.hpp"
#include "support/shared_data.hpp"

/// The measuring train's logs around Brussels airport: paths, and the along-track error where fixes were hidden.
namespace versine::io {
namespace {

using namespace test;

TEST(BrusselsAccuracy, ExpectedPathsMonotoneAndHiddenFixes) {
  VERSINE_NEEDS(folder, "brussels-airport");
  const Fixture f(folder);
  const georef::Options options;
  std::map<double, Errors> errors;
  for (const auto& [name, ids] : f.expected) {
    const auto log = f.log(name);
    const auto result = georef::georeference(*f.map, log, options);
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(ids_of(*f.map, *result), ids) << name;
    for (const auto& j : result->journeys) {
      const auto& best = j.paths.front();
      fmt::print("{}: {:.0f} s, path probability {:.4f}, {} paths, {} rejected of {}\n", name,
                 (j.end() - j.start).seconds(), best.probability, j.paths.size(),
                 std::count_if(best.residuals.begin(), best.residuals.end(), [](auto& r) { return r.weight == 0.0F; }),
                 best.residuals.size());
      EXPECT_TRUE(std::is_sorted(best.motion.distance.begin(), best.motion.distance.end()));
      EXPECT_EQ(network::first_infeasible(f.map->network, best.coordinates.path()), best.coordinates.path().size());
    }
    if (name == "log_29083") continue;
    for (const double w : {10.0, 30.0}) EXPECT_TRUE(hide(f, log, ids, w, options, errors[w]));
  }
  for (const auto& [w, e] : errors) {
    fmt::print("hidden {:.0f} s: n {}, RMS {:.3f} m, worst {:.2f} m, coverage of 95 % interval {:.3f}\n", w, e.n,
               e.rms(), e.worst, e.coverage());
  }
  EXPECT_LT(errors[10.0].rms(), 0.28);
  EXPECT_LT(errors[30.0].rms(), 3.13);
  for (const auto& [w, e] : errors) EXPECT_GE(e.coverage(), 0.90);
}

}  // namespace
}  // namespace versine::io
