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

#define VERSINE_NEEDS_RTKLIB() \
  if (!find_program("rnx2rtkp")) GTEST_SKIP() << "RTKLIB's rnx2rtkp is not installed"

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

// RTKLIB's own program with the same options on the command line: the same fixes, the same positions.
TEST(GnssEngine, AgreesWithRtklibsOwnProgram) {
  VERSINE_NEEDS(folder, "rinex/geonet-0759-3040");
  VERSINE_NEEDS_RTKLIB();
  GnssProcessing g = geonet(folder);
  g.options.lock_epochs = 0;
  g.options.fix_elevation = 0.0;
  const auto r = process(g);
  ASSERT_TRUE(r) << r.error().message();
  const fs::path out = fs::temp_directory_path() / "versine-gnss-oracle.pos";
  const std::vector<std::string> arguments{"-p",
                                           "2",
                                           "-m",
                                           "15",
                                           "-sys",
                                           "G",
                                           "-f",
                                           "2",
                                           "-v",
                                           "3",
                                           "-c",
                                           "-o",
                                           out.string(),
                                           g.rover[0].path.string(),
                                           g.base[0].path.string(),
                                           g.navigation[0].path.string(),
                                           "-r",
                                           "-3978241.958",
                                           "3382840.234",
                                           "3649900.853"};
  ASSERT_TRUE(run_process(*find_program("rnx2rtkp"), arguments, [](std::string_view) { return true; }));
  const auto oracle = io::read_gnss({.table = {.path = out}, .format = io::GnssFile::Format::rtklib});
  ASSERT_TRUE(oracle) << oracle.error().message();
  fs::remove(out);
  ASSERT_EQ(r->series.size(), oracle->series.size());
  for (std::size_t i = 0; i < r->series.size(); ++i) {
    EXPECT_EQ(r->series[i].time, oracle->series[i].time);
    EXPECT_EQ(r->series[i].fix, oracle->series[i].fix);
    EXPECT_LT((ecef(r->series[i]) - ecef(oracle->series[i])).norm(), 1e-3);
  }
}

TEST(GnssEngine, HardMovingRoverIsReportedHonestly) {
  VERSINE_NEEDS(folder, "rinex/moving-rover-fujisawa");
  VERSINE_NEEDS_RTKLIB();
  GnssProcessing g;
  g.rover = {input(folder / "SEPT265G.21O.zst")};
  g.base = {input(folder / "3034265G.21O.zst")};
  g.navigation = {input(folder / "SEPT2650.21P.zst")};
  g.base_ecef = Eigen::Vector3d(-3959400.631, 3385704.533, 3667523.111);
  const auto r = process(g);
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
