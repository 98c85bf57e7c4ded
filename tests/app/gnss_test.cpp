// SPDX-License-Identifier: Apache-2.0
#include "versine/app/gnss.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include "support/shared_data.hpp"
#include "versine/core/process.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/io/input_stream.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {
namespace {

using sensors::FixType;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

#define VERSINE_NEEDS_RTKLIB() VERSINE_NEEDS_PROGRAM("rnx2rtkp", "rtklib")

InputPath input(const fs::path& p) {
  return {p, p.filename().string()};
}

Eigen::Vector3d ecef(const sensors::GnssSample& s) {
  return geodesy::wgs84.to_ecef(s.position).r;
}

Eigen::Vector3d mean(const Series<sensors::GnssSample>& series) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& s : series) sum += ecef(s);
  return sum / static_cast<double>(series.size());
}

std::size_t fixes(const Series<sensors::GnssSample>& series) {
  return static_cast<std::size_t>(
      std::count_if(series.begin(), series.end(), [](const auto& s) { return s.fix == FixType::fixed; }));
}

const Eigen::Vector3d spirent_base(4157177.06580187, 671230.476590636, 4774767.03105544);
const Eigen::Vector3d spirent_rover(4156857.1195929, 673209.028774142, 4774767.03105544);

GnssProcessing spirent(const fs::path& folder) {
  GnssProcessing g;
  g.rover = {input(folder / "Rover-static-2km-east_MO_Spirent.obs.zst")};
  g.base = {input(folder / "Base-static_MO_Spirent.obs.zst")};
  g.navigation = {input(folder / "RINEX_GN_Spirent.23N.zst"), input(folder / "RINEX_EN_Spirent.23L.zst")};
  g.base_ecef = spirent_base;
  return g;
}

GnssProcessing geonet(const fs::path& folder) {
  GnssProcessing g;
  g.rover = {input(folder / "07590920.05o")};
  g.base = {input(folder / "30400920.05o")};
  g.navigation = {input(folder / "07590920.05n")};
  g.base_ecef = Eigen::Vector3d(-3978241.958, 3382840.234, 3649900.853);
  g.options.systems = {"GPS"};
  return g;
}

Expected<GnssResult> process(const GnssProcessing& g) {
  SilentProgress progress;
  SilentLog log;
  return process_gnss(g, progress, log);
}

TEST(GnssEngine, SpirentStaticRoverWithinTwoMillimetres) {
  VERSINE_NEEDS(folder, "rinex/spirent-static-2km");
  VERSINE_NEEDS_RTKLIB();
  const auto r = process(spirent(folder));
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_EQ(r->series.size(), 601u);
  EXPECT_EQ(fixes(r->series), 601u);
  EXPECT_EQ(r->confirmed, 601u);
  EXPECT_EQ(r->doubted, 0u);
  const Eigen::Vector3d e = mean(r->series) - spirent_rover;
  std::printf("spirent: mean off by %.2f %.2f %.2f mm\n", e.x() * 1e3, e.y() * 1e3, e.z() * 1e3);
  EXPECT_LT(e.norm(), 2e-3);
}

TEST(GnssEngine, GeonetStaticBaseline) {
  VERSINE_NEEDS(folder, "rinex/geonet-0759-3040");
  VERSINE_NEEDS_RTKLIB();
  GnssProcessing g = geonet(folder);
  const auto r = process(g);
  ASSERT_TRUE(r) << r.error().message();
  const Eigen::Vector3d e = mean(r->series) - Eigen::Vector3d(-3976219.1868, 3382371.6036, 3652511.1412);
  std::printf("geonet: %zu of %zu fixed, %zu doubted, mean off by %.1f mm\n", r->fixed, r->series.size(), r->doubted,
              e.norm() * 1e3);
  EXPECT_LT(e.norm(), 5e-3);
}

GnssProcessing fujisawa(const fs::path& folder) {
  GnssProcessing g;
  g.rover = {input(folder / "SEPT265G.21O.zst")};
  g.base = {input(folder / "3034265G.21O.zst")};
  g.navigation = {input(folder / "SEPT2650.21P.zst")};
  g.base_ecef = Eigen::Vector3d(-3959400.631, 3385704.533, 3667523.111);
  return g;
}

/// The options as a user of RTKLIB would write them; `systems` is its mask (1 GPS, 4 GLONASS, 8 Galileo).
std::string written_by_hand(int systems, const Eigen::Vector3d& base) {
  char position[128];
  std::snprintf(position, sizeof position, "ant2-pos1=%.8f\nant2-pos2=%.8f\nant2-pos3=%.8f\n", base.x(), base.y(),
                base.z());
  return "pos1-posmode=kinematic\npos1-frequency=l1+l2\npos1-soltype=combined\npos1-elmask=15\npos1-dynamics=off\n"
         "pos1-ionoopt=brdc\npos1-tropopt=saas\npos1-sateph=brdc\npos1-navsys=" +
         std::to_string(systems) +
         "\npos2-armode=continuous\npos2-gloarmode=off\npos2-arthres=3\npos2-arlockcnt=5\npos2-arelmask=15\n"
         "pos2-maxage=30\nout-solformat=llh\nout-timesys=gpst\nout-timeform=tow\nout-degform=deg\n"
         "out-height=ellipsoidal\nant2-postype=xyz\n" +
         position;
}

/// What RTKLIB's own program makes of the job's files.
Expected<io::Read<Series<sensors::GnssSample>>> by_rtklib(const GnssProcessing& g, int systems) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const fs::path folder = fs::temp_directory_path() / ("versine-rtklib-" + test);
  fs::create_directories(folder);
  std::ofstream(folder / "own.conf") << written_by_hand(systems, *g.base_ecef);
  std::vector<std::string> arguments{"-k", (folder / "own.conf").string(), "-o", (folder / "own.pos").string()};
  int number = 0;
  for (const auto* group : {&g.rover, &g.base, &g.navigation}) {
    for (const InputPath& f : *group) {
      const auto text = io::read_text(f.path);  // rnx2rtkp knows no zstd
      if (!text) return tl::unexpected(text.error());
      arguments.push_back((folder / ("input" + std::to_string(number++))).string());
      std::ofstream(arguments.back(), std::ios::binary) << *text;
    }
  }
  const auto done = run_process(*find_program("rnx2rtkp"), arguments, [](std::string_view) { return true; });
  if (!done) return tl::unexpected(done.error());
  auto read = io::read_gnss({.table = {.path = folder / "own.pos"}, .format = io::GnssFile::Format::rtklib});
  fs::remove_all(folder);
  return read;
}

/// Every epoch of both: the same time, the same fix, the same place. Epochs that the job doubts (its two directions
/// contradict each other) are the only ones whose fix may differ.
void expect_same(const GnssResult& ours, const Series<sensors::GnssSample>& theirs) {
  ASSERT_EQ(ours.series.size(), theirs.size());
  std::size_t taken_back = 0;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    ASSERT_EQ(ours.series[i].time, theirs[i].time);
    // RTKLIB writes angles to 1e-9 deg, a tenth of a millimetre: a last digit may round the other way.
    ASSERT_LT((ecef(ours.series[i]) - ecef(theirs[i])).norm(), 0.3e-3) << "epoch " << i;
    if (ours.series[i].fix == theirs[i].fix) continue;
    EXPECT_EQ(theirs[i].fix, FixType::fixed) << "epoch " << i;
    EXPECT_EQ(ours.series[i].fix, FixType::float_ambiguity) << "epoch " << i;
    ++taken_back;
  }
  EXPECT_EQ(taken_back, ours.doubted);
  EXPECT_EQ(fixes(theirs), ours.fixed);
}

void expect_same_as_rtklib(const GnssProcessing& g, int systems) {
  const auto ours = process(g);
  ASSERT_TRUE(ours) << ours.error().message();
  const auto theirs = by_rtklib(g, systems);
  ASSERT_TRUE(theirs) << theirs.error().message();
  expect_same(*ours, theirs->series);
}

TEST(GnssEngine, SameAsRtklibsOwnProgramSpirent) {
  VERSINE_NEEDS(folder, "rinex/spirent-static-2km");
  VERSINE_NEEDS_RTKLIB();
  expect_same_as_rtklib(spirent(folder), 1 + 4 + 8);
}

TEST(GnssEngine, SameAsRtklibsOwnProgramGeonet) {
  VERSINE_NEEDS(folder, "rinex/geonet-0759-3040");
  VERSINE_NEEDS_RTKLIB();
  expect_same_as_rtklib(geonet(folder), 1);
}

TEST(GnssEngine, SameAsRtklibsOwnProgramFujisawa) {
  VERSINE_NEEDS(folder, "rinex/moving-rover-fujisawa");
  VERSINE_NEEDS_RTKLIB();
  expect_same_as_rtklib(fujisawa(folder), 1 + 4 + 8);
}

TEST(GnssEngine, HardMovingRoverIsReportedHonestly) {
  VERSINE_NEEDS(folder, "rinex/moving-rover-fujisawa");
  VERSINE_NEEDS_RTKLIB();
  const auto r = process(fujisawa(folder));
  ASSERT_TRUE(r) << r.error().message();
  std::printf("fujisawa: %zu epochs, %zu positions, combined fixed %zu, confirmed %zu, doubted %zu, fixed left %zu\n",
              r->epochs, r->series.size(), r->fixed, r->confirmed, r->doubted, fixes(r->series));
  EXPECT_EQ(r->epochs, 360u);
  EXPECT_EQ(r->series.size(), 360u);
  EXPECT_LT(r->confirmed, r->fixed);  // both directions agree on few epochs only
  EXPECT_GT(r->doubted, 0u);
  EXPECT_LE(fixes(r->series) + 0u, r->fixed);
  EXPECT_FALSE(r->record.findings.empty());
}

TEST(GnssEngine, RefusesWithTheCure) {
  VERSINE_NEEDS(folder, "rinex");
  VERSINE_NEEDS_RTKLIB();
  const GnssProcessing good = spirent(folder / "spirent-static-2km");
  GnssProcessing g = good;
  g.navigation.clear();
  EXPECT_THAT(process(g).error().message(), HasSubstr("no navigation data"));
  g = good;
  g.navigation = {input(folder / "geonet-0759-3040/07590920.05n")};
  EXPECT_THAT(process(g).error().message(), HasSubstr("day of the measurement"));
  g = good;
  g.base = {input(folder / "geonet-0759-3040/30400920.05o")};
  EXPECT_THAT(process(g).error().message(), HasSubstr("a time in common with the rover"));
  g = good;
  g.base_ecef = spirent_base + Eigen::Vector3d(0.0, 100e3, 0.0);
  EXPECT_THAT(process(g).error().message(), HasSubstr("100.0 km from the base's own code solution"));
  g = good;
  std::swap(g.base, g.navigation);
  EXPECT_THAT(process(g).error().message(), HasSubstr("put the file under the other key"));
}

}  // namespace
}  // namespace versine::app
