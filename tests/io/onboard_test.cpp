// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "../../src/io/hdf5_file.hpp"
#include "versine/io/journey_onboard.hpp"

namespace versine::io {
namespace {

class Onboard : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("versine_onboard_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static void put(Hdf5File& file, const std::string& name, std::vector<double> values) {
    file.write(name, std::span<const double>(values), "");
  }
  static void gnss(Hdf5File& file, const std::string& journey) {
    file.group(journey);
    file.group(journey + "/GNSS");
    put(file, journey + "/GNSS/times", {0.0, 1.0, 2.0});
    put(file, journey + "/GNSS/lon", {10.0, 10.1, 10.2});
    put(file, journey + "/GNSS/lat", {50.0, 50.1, 50.2});
  }
  std::filesystem::path folder_;
};

TEST_F(Onboard, MissingGroupsAreNamedAndTheRestIsRead) {
  const auto path = folder_ / "fleet.h5";
  {
    auto file = Hdf5File::create(path);
    ASSERT_TRUE(file);
    gnss(*file, "journey_01");
    file->group("journey_02");  // nothing in it
    gnss(*file, "journey_03");
    file->group("journey_03/IMU");  // without its datasets
    file->group("journey_04");
    file->group("journey_04/GNSS");
    put(*file, "journey_04/GNSS/times", {0.0, 1.0});
    put(*file, "journey_04/GNSS/lon", {10.0, 10.1, 10.2});
    ASSERT_TRUE(file->close());
  }
  const auto read = read_onboard(path);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->recordings.size(), 1u);
  EXPECT_EQ(read->recordings[0].gnss.size(), 3u);
  ASSERT_EQ(read->faults.size(), 3u);
  EXPECT_EQ(read->faults[0].field, "journey_02/GNSS");
  EXPECT_EQ(read->faults[1].field, "journey_03/IMU/times");
  EXPECT_EQ(read->faults[2].field, "journey_04/GNSS/lon");
  for (const auto& f : read->faults) EXPECT_EQ(f.file, path.string());
}

TEST_F(Onboard, AFileWithoutJourneysIsRefused) {
  const auto path = folder_ / "empty.h5";
  {
    auto file = Hdf5File::create(path);
    ASSERT_TRUE(file);
    file->group("something");
    ASSERT_TRUE(file->close());
  }
  const auto read = read_onboard(path);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().found.find("journey"), std::string::npos);
}

}  // namespace
}  // namespace versine::io
