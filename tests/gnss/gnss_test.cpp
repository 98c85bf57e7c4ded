// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "versine/geodesy/ellipsoid.hpp"
#include "versine/gnss/agreement.hpp"
#include "versine/gnss/fixed_sigma.hpp"
#include "versine/gnss/options.hpp"
#include "versine/gnss/rinex_scan.hpp"

namespace versine::gnss {
namespace {

using sensors::FixType;
using sensors::GnssSample;

Series<GnssSample> series(int n, FixType fix, const Eigen::Vector3d& offset, int from = 0, int to = 0) {
  Series<GnssSample> s;
  const geodesy::Geodetic place{0.85, 0.16, 300.0};
  for (int i = 0; i < n; ++i) {
    GnssSample g{
        .time = {i * 1'000'000'000LL}, .position = place, .sigma_ned = Eigen::Vector3d(0.005, 0.005, 0.01), .fix = fix};
    if (i >= from && i < to) g.position = geodesy::wgs84.displaced(place, offset);
    s.samples.push_back(g);
  }
  return s;
}

TEST(Agreement, AWrongFixOfDecimetresInOneDirectionIsDoubted) {
  const Eigen::Vector3d wrong(0.2, -0.1, 0.3);
  const auto forward = series(100, FixType::fixed, wrong, 40, 60);
  auto backward = series(100, FixType::fixed, wrong);
  std::reverse(backward.samples.begin(), backward.samples.end());  // as RTKLIB may write it
  const auto a = compare_directions(series(100, FixType::fixed, wrong, 40, 60), forward, backward, {});
  EXPECT_EQ(a.fixed, 100u);
  EXPECT_EQ(a.confirmed, 80u);
  EXPECT_EQ(a.doubted, 20u);
  ASSERT_EQ(a.findings.size(), 1u);
  EXPECT_EQ(a.findings[0].count, 20u);
  EXPECT_EQ(a.series[50].fix, FixType::float_ambiguity);
  EXPECT_NEAR(a.series[50].sigma_ned.x(), 0.2, 1e-6);
  EXPECT_EQ(a.series[39].fix, FixType::fixed);
}

TEST(Agreement, DifferencesWithinTheirSigmasAreNot) {
  const auto a = compare_directions(series(10, FixType::fixed, {}), series(10, FixType::fixed, {0.01, 0, 0}, 0, 10),
                                    series(10, FixType::fixed, {}), {});
  EXPECT_EQ(a.doubted, 0u);
}

TEST(FixedSigma, NothingAndScatterAreRaisedToWhatIsUsual) {
  auto s = series(100, FixType::fixed, {});
  s.samples[50].sigma_ned.y() = 0.5e-4;
  s.samples[60].sigma_ned.z() = 0.05;
  s.samples[70].fix = FixType::float_ambiguity;
  s.samples[70].sigma_ned.setConstant(1e-3);
  const auto steady = with_steady_sigmas(s);
  EXPECT_DOUBLE_EQ(steady[50].sigma_ned.y(), 0.005);
  EXPECT_DOUBLE_EQ(steady[60].sigma_ned.z(), 0.05);
  EXPECT_DOUBLE_EQ(steady[70].sigma_ned.y(), 1e-3);
}

TEST(Options, ConfigurationSaysWhatWasAsked) {
  Options o;
  o.positioning = Positioning::standing;
  o.systems = {"GPS", "Galileo"};
  o.base_ecef = Eigen::Vector3d(4157177.0658, 671230.4766, 4774767.0311);
  const std::string text = rtklib_configuration(o, Direction::backward);
  for (const char* line : {"pos1-posmode       =static\n", "pos1-soltype       =backward\n", "pos1-navsys        =9\n",
                           "ant2-postype       =xyz\n", "ant2-pos1          =4157177.065800\n"}) {
    EXPECT_THAT(text, ::testing::HasSubstr(line));
  }
}

TEST(RinexScan, TellsWhatAFileIs) {
  EXPECT_EQ(raw_kind("\xB5\x62 abc"), RawKind::ublox);
  EXPECT_EQ(raw_kind("\xAA\x44\x12 abc"), RawKind::novatel);
  EXPECT_EQ(raw_kind("hello"), RawKind::unknown);
  const std::string header =
      "     3.04           OBSERVATION DATA    M: MIXED            RINEX VERSION / TYPE\n"
      "  4156857.1196   673209.0288  4774767.0311                  APPROX POSITION XYZ \n";
  const auto cut = scan_rinex(header, "a.obs");
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().found, ::testing::HasSubstr("does not end"));
  const auto scan = scan_rinex(header +
                                   "                                                            END OF HEADER       \n"
                                   "> 2023 01 08 10 00  0.0000000  0 12\nG01  1.0\n"
                                   "> 2023 01 08 10 00  1.0000000  0 12\n> 2023 01 08 10 00  2.0000000  0 12\n",
                               "a.obs");
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->epochs, 3u);
  EXPECT_DOUBLE_EQ(scan->interval, 1.0);
  EXPECT_EQ(scan->first.ns, (2244LL * 604800 + 36000) * 1'000'000'000);
  ASSERT_TRUE(scan->approximate);
}

}  // namespace
}  // namespace versine::gnss
