// SPDX-License-Identifier: Apache-2.0
#include "versine/app/recording_info.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/shared_data.hpp"

namespace versine::app {
namespace {

TEST(RecordingInfo, CarImuIsRecognised) {
  VERSINE_NEEDS(path, "car-rtk-drive/drive_0708_imu_1934_gpst.csv.zst");
  const auto info = recording_info(path);
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->samples, 54858u);
  ASSERT_EQ(info->guesses.size(), 2u);
  EXPECT_NE(info->guesses[0].what.find("accelerometers in g"), std::string::npos);
  EXPECT_NE(info->guesses[1].what.find("z points up"), std::string::npos);
  EXPECT_NE(to_json(*info).find("gyro_x_dps"), std::string::npos);
}

TEST(RecordingInfo, RtklibShowsFixesRateAndPlace) {
  VERSINE_NEEDS(path, "car-rtk-drive/drive_0708_gnss_1934_sf.pos.zst");
  const auto info = recording_info(path);
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->format, "RTKLIB solution");
  EXPECT_EQ(info->fixes, (std::vector<std::pair<std::string, std::size_t>>{{"fixed", 2189}, {"float", 8}}));
  EXPECT_EQ(info->time->interval.ns, 250'000'000);
  EXPECT_NE(to_text(*info).find("4 Hz"), std::string::npos);
}

TEST(RecordingInfo, WhatIsNoRecordingIsAnError) {
  const auto path = std::filesystem::temp_directory_path() / "versine_prose.txt";
  std::ofstream(path) << "once upon a time\nthere was a train\nand it ran\n";
  const auto info = recording_info(path);
  std::filesystem::remove(path);
  ASSERT_FALSE(info);
  EXPECT_FALSE(info.error().advice.empty());
}

}  // namespace
}  // namespace versine::app
