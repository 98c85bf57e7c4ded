// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>

#include "versine/io/monitoring_file.hpp"
#include "versine/io/monitoring_result.hpp"
#include "versine/network/build.hpp"

/// Monitoring files block by block, and what is written beside them, read back.
namespace versine::io {
namespace {

namespace fs = std::filesystem;

struct Scratch {
  fs::path folder = fs::path(testing::TempDir()) /
                    ("versine-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  Scratch() { fs::create_directories(folder); }
  ~Scratch() { fs::remove_all(folder); }
};

template <class T>
void put(hid_t file, const char* name, hid_t type, const std::vector<T>& values) {
  const hsize_t size = values.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set), H5Sclose(space);
}

template <class T>
std::vector<T> get(hid_t file, const char* name, hid_t type) {
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space), H5Dclose(set);
  return values;
}

fs::path make_axlebox(const fs::path& folder, std::size_t n) {
  const fs::path path = folder / "axlebox.h5";
  std::vector<std::int16_t> left, right;
  std::vector<double> seconds;
  for (std::size_t i = 0; i < n; ++i) {
    left.push_back(static_cast<std::int16_t>(i % 1000));
    right.push_back(static_cast<std::int16_t>(-static_cast<int>(i % 7)));
    seconds.push_back(100.0 + static_cast<double>(i) / 20000.0);
  }
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  put(file, "left", H5T_NATIVE_INT16, left);
  put(file, "right", H5T_NATIVE_INT16, right);
  put(file, "times", H5T_NATIVE_DOUBLE, seconds);
  H5Fclose(file);
  return path;
}

TEST(Monitoring, BlocksOfAnHdf5FileAreItsSamples) {
  const Scratch scratch;
  const std::size_t n = 150'001;
  MonitoringFile file{make_axlebox(scratch.folder, n), {"left", "right"}, "", 20000.0, 100.0, 0.5, 0.01};
  const auto before = fs::last_write_time(file.path);
  for (const bool times : {false, true}) {
    file.times = times ? "times" : "";
    file.rate_hz = times ? std::nullopt : std::optional(20000.0);
    auto reader = MonitoringReader::open(file);
    ASSERT_TRUE(reader) << reader.error().message();
    EXPECT_EQ(reader->samples(), n);
    georef::SampleBlock block;
    std::size_t seen = 0;
    while (*reader->next(block)) {
      ASSERT_EQ(block.first, seen);
      ASSERT_LE(block.times.size(), 65536u);
      for (std::size_t i = 0; i < block.times.size(); ++i, ++seen) {
        ASSERT_EQ(block.times[i].ns, 100'500'000'000 + static_cast<std::int64_t>(seen) * 50'000);
        ASSERT_FLOAT_EQ(block.channels[0][i], 0.01F * static_cast<float>(seen % 1000));
        ASSERT_FLOAT_EQ(block.channels[1][i], -0.01F * static_cast<float>(seen % 7));
      }
    }
    EXPECT_EQ(seen, n);
  }
  EXPECT_EQ(fs::last_write_time(file.path), before);
}

TEST(Monitoring, CsvAndFaultsAreNamed) {
  const Scratch scratch;
  const fs::path path = scratch.folder / "axlebox.csv";
  std::ofstream(path) << "t,left\n10.0,1.5\n10.00005,-2.5\n10.0001,3\n";
  auto reader = MonitoringReader::open({path, {"left"}, "t", {}, 0.0, 0.0, 2.0});
  ASSERT_TRUE(reader) << reader.error().message();
  georef::SampleBlock block;
  ASSERT_TRUE(*reader->next(block));
  EXPECT_EQ(block.times[1].ns, 10'000'050'000);
  EXPECT_EQ(block.channels[0], (std::vector<float>{3.0F, -5.0F, 6.0F}));
  EXPECT_FALSE(*reader->next(block));

  const auto missing = MonitoringReader::open({path, {"right"}, "t", {}, 0.0, 0.0, 1.0});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().field, "right");
  EXPECT_NE(missing.error().found.find("t, left"), std::string::npos);
  EXPECT_FALSE(MonitoringReader::open({path, {"left"}, "t", 5.0, 0.0, 0.0, 1.0}));  // times and a rate
  EXPECT_FALSE(MonitoringReader::open({path, {"left"}, "", {}, 0.0, 0.0, 1.0}));    // neither

  std::ofstream(path) << "t,left\n10.0,1.5\n10.0,-2.5\n";
  auto standing = MonitoringReader::open({path, {"left"}, "t", {}, 0.0, 0.0, 1.0});
  const auto read = standing->next(block);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().line, 2u);
}

TEST(Monitoring, ResultComesBack) {
  const Scratch scratch;
  network::NetworkSource source;
  source.crs = "EPSG:32632";
  source.tracks.push_back({"one", {{500000.0, 5500000.0}, {502000.0, 5500000.0}}, 1, {}, {}, {}});
  const georef::Map map(std::move(*network::build(source)));
  georef::RecordingResult result;
  georef::JourneyResult j;
  j.start = Time::from_seconds(100.0);
  j.grid = 0.1;
  j.steps = 501;
  georef::PathSolution p;
  p.coordinates = network::PathCoordinates(map.network, {{0, false}});
  p.probability = 0.75;
  for (std::size_t k = 0; k < j.steps; ++k) {
    p.motion.distance.push_back(300.0 + 2.0 * static_cast<double>(k));
    p.motion.speed.push_back(20.0F);
    p.motion.sigma_distance.push_back(0.25F);
    p.motion.sigma_speed.push_back(0.1F);
  }
  j.paths.push_back(std::move(p));
  result.journeys.push_back(std::move(j));

  auto reader =
      MonitoringReader::open({make_axlebox(scratch.folder, 200'000), {"left", "right"}, "times", {}, 0.0, 0.0, 1.0});
  const fs::path path = scratch.folder / "monitoring_1.h5";
  auto out = MonitoringResult::create(path, "axlebox.h5", map, {"left", "right"});
  ASSERT_TRUE(out);
  georef::MonitoringStamper stamper(map, result, 2, {.position_rate = 2000.0});
  georef::SampleBlock block;
  while (*reader->next(block)) {
    stamper.add(block);
    out->take(stamper);
  }
  stamper.finish();
  out->take(stamper);
  ASSERT_TRUE(out->close());
  {
    const auto done = std::move(*out);  // closes the file
  }
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const auto from = get<double>(file, "metres/from_m", H5T_NATIVE_DOUBLE);
  const auto rms = get<float>(file, "metres/rms_2", H5T_NATIVE_FLOAT);
  ASSERT_EQ(from.size(), 200u);  // 10 s at 20 m/s
  EXPECT_NEAR(from.front(), 300.0, 1e-9);
  EXPECT_NEAR(rms[100], std::sqrt((0 + 1 + 4 + 9 + 16 + 25 + 36) / 7.0), 0.02);
  const auto at = get<double>(file, "positions/track_distance_m", H5T_NATIVE_DOUBLE);
  const auto ns = get<std::int64_t>(file, "positions/time_ns", H5T_NATIVE_INT64);
  ASSERT_EQ(at.size(), 20'000u);
  for (std::size_t i = 0; i < at.size(); i += 777) {
    EXPECT_NEAR(at[i], 300.0 + 20.0 * (static_cast<double>(ns[i]) * 1e-9 - 100.0), 1e-6);
  }
  const auto probability = get<float>(file, "table/probability", H5T_NATIVE_FLOAT);
  EXPECT_FLOAT_EQ(probability.front(), 0.75F);
  EXPECT_LT(probability.size(), 10u);  // uniform motion needs no rows
  H5Fclose(file);
}

}  // namespace
}  // namespace versine::io
