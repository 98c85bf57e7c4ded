// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "support/shared_data.hpp"
#include "versine/io/total_station_formats.hpp"
#include "versine/stationing/free_station.hpp"
#include "versine/stationing/network_adjustment.hpp"

namespace versine::io {
namespace {

std::string content(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The network's own adjustment states 1 mgon and 1.5 mm for the mean of all sets; points and instruments are forced
/// centred, heights read to the millimetre.
std::vector<stationing::ReducedStation> reduced(const FieldBook& book, const stationing::Instrument& instrument) {
  std::vector<stationing::ReducedStation> stations;
  for (const auto& s : book.stationings) {
    auto r = stationing::reduce(s, instrument);
    EXPECT_TRUE(r) << r.error().message();
    EXPECT_TRUE(r->sets == 7 || r->sets == 14) << r->name << " " << r->sets;
    EXPECT_EQ(r->dropped, 0u);
    EXPECT_LT(std::abs(*r->collimation), 3.0 * units::mgon);
    for (auto& t : r->targets) t.direction_sigma = t.zenith_sigma = 1.0 * units::mgon;
    stations.push_back(std::move(*r));
  }
  return stations;
}

const stationing::Instrument leica{
    .angle_sigma = 1.0 * units::mgon, .distance_sigma = 1.5e-3, .distance_sigma_ppm = 0.0, .target_sigma = 0.0};

TEST(LeicaNetwork, FreeAdjustmentFitsTheFiguresGivenWithIt) {
  VERSINE_NEEDS(path, "total-station/network.GSI");
  const auto book = parse_field_book(content(path), path.string());
  ASSERT_TRUE(book) << book.error().message();
  ASSERT_EQ(book->stationings.size(), 22u);
  const auto stations = reduced(*book, leica);
  stationing::NetworkOptions options{.tilt_sigma = 0.01 * units::arcsec, .free = true, .snoop = false};
  const auto all = stationing::adjust_network(stations, {}, leica, options);
  ASSERT_TRUE(all) << all.error().message();
  EXPECT_EQ(all->points.size(), 22u);
  EXPECT_EQ(all->residuals.size(), 100u);
  EXPECT_EQ(all->redundancy, 216);
  options.snoop = true;
  const auto clean = stationing::adjust_network(stations, {}, leica, options);
  ASSERT_TRUE(clean) << clean.error().message();
  std::printf("sigma0 of all %.3f, without what fails %.3f\n", all->sigma0, clean->sigma0);
  EXPECT_NEAR(clean->sigma0, 0.978, 0.05);  // the figure that comes with the data
  std::size_t out = 0;
  for (const auto& r : clean->residuals) out += !r.used;
  EXPECT_EQ(out, 4u);  // all of them 3 mm in height, none in plan: heights of instruments and prisms as typed in
  double redundancy = 0.0;
  for (const auto& r : clean->residuals) redundancy += r.used ? r.redundancy.sum() : 0.0;
  EXPECT_NEAR(redundancy, clean->redundancy, 0.5);  // the tilts hold the small rest
}

// Each station again by itself, on the adjusted points: it must come back to where the network has it.
TEST(LeicaNetwork, EachStationAsFreeStationing) {
  VERSINE_NEEDS(path, "total-station/network.GSI");
  const auto book = parse_field_book(content(path), path.string());
  ASSERT_TRUE(book) << book.error().message();
  const auto stations = reduced(*book, leica);
  const auto net = stationing::adjust_network(stations, {}, leica, {.tilt_sigma = 0.01 * units::arcsec, .free = true});
  ASSERT_TRUE(net) << net.error().message();
  std::vector<stationing::ControlPoint> points;
  for (const auto& p : net->points) points.push_back({p.name, p.position, p.covariance});
  const auto control = *stationing::ControlNetwork::create(points);
  double squares = 0.0;
  std::size_t solved = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto r = stationing::free_station(stations[i], control, leica, {.tilt_sigma = 1.0 * units::arcsec});
    ASSERT_TRUE(r) << r.error().message();
    const Eigen::Vector3d e = r->position - net->stations[i].position;
    std::printf("%-5s %zu targets: %6.2f %6.2f %6.2f mm, sigma %5.2f %5.2f %5.2f mm, %zu left out\n", r->name.c_str(),
                r->targets.size(), e.x() * 1e3, e.y() * 1e3, e.z() * 1e3, std::sqrt(r->covariance(0, 0)) * 1e3,
                std::sqrt(r->covariance(1, 1)) * 1e3, std::sqrt(r->covariance(2, 2)) * 1e3, r->excluded.size());
    squares += e.squaredNorm();
    ++solved;
  }
  EXPECT_EQ(solved, 22u);
  EXPECT_LT(std::sqrt(squares / (3.0 * solved)), 1.0e-3);
}

TEST(FieldBooks, TwoPointsOfGsi8InDegrees) {
  const auto book = parse_gsi(
      "410001+00000021 42....+00000007 43....+00001500\n"
      "110002+0000CP01 21.323+09000000 22.324+08959300 31..00+00050000 87..10+00001300\n",
      "job.gsi");
  ASSERT_TRUE(book) << book.error().message();
  const auto& s = book->stationings.at(0);
  EXPECT_EQ(s.name, "7");
  EXPECT_DOUBLE_EQ(s.instrument_height, 1.5);
  EXPECT_EQ(s.sightings.at(0).point, "CP01");
  EXPECT_NEAR(s.sightings[0].direction, 90.0 * units::deg, 1e-12);
  EXPECT_NEAR(s.sightings[0].zenith, (89.0 + 59.0 / 60.0 + 30.0 / 3600.0) * units::deg, 1e-12);
  EXPECT_DOUBLE_EQ(s.sightings[0].distance, 50.0);
  EXPECT_FALSE(parse_gsi("110002+0000CP01 21.325x09000000\n", "job.gsi"));
  EXPECT_EQ(parse_gsi("110002+0000CP01 21.320+09000000 22.320+09000000\n", "job.gsi").error().line, 1u);
}

TEST(FieldBooks, Sdr33) {
  const auto book = parse_field_book(
      "00NMSDR33 V04-04.02     01-Jan-20 10:00 211111\n"
      "02TP            1000100.0000000     200.0000000     10.00000000     1.50500000      11              \n"
      "03NM1.60000000      \n"
      "09F1            1000            100125.000000000    99.0000000000   50.0000000000   \n"
      "09F2            1000            100125.000100000    301.0000000000  250.0000000000  \n",
      "job.sdr");
  ASSERT_TRUE(book) << book.error().message();
  ASSERT_EQ(book->stationings.size(), 1u);
  const auto& s = book->stationings[0];
  EXPECT_EQ(s.name, "1000");
  EXPECT_DOUBLE_EQ(s.instrument_height, 1.505);
  ASSERT_EQ(s.sightings.size(), 2u);
  EXPECT_EQ(s.sightings[0].point, "1001");
  EXPECT_DOUBLE_EQ(s.sightings[0].distance, 25.0);
  EXPECT_NEAR(s.sightings[0].zenith, 99.0 * units::gon, 1e-12);
  EXPECT_EQ(s.sightings[1].face, stationing::Face::two);
  EXPECT_DOUBLE_EQ(s.sightings[1].target_height, 1.6);
  EXPECT_DOUBLE_EQ(book->coordinates.at(0).map.northing, 100.0);
}

TEST(FieldBooks, GeoEasy) {
  VERSINE_NEEDS(folder, "total-station");
  const auto points = parse_field_book(content(folder / "test1.coo"), "test1.coo");
  ASSERT_TRUE(points) << points.error().message();
  EXPECT_DOUBLE_EQ(points->coordinates.at(0).map.easting, 91515.44);
  const auto book = parse_field_book(content(folder / "test1.geo"), "test1.geo");
  ASSERT_TRUE(book) << book.error().message();
  EXPECT_FALSE(book->warnings.empty());  // directions without zenith angles
  std::size_t sightings = 0;
  for (const auto& s : book->stationings) sightings += s.sightings.size();
  EXPECT_EQ(sightings, 14u);
  EXPECT_FALSE(parse_field_book("hello", "x.txt"));
}

}  // namespace
}  // namespace versine::io
