// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "support/shared_data.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::io {
namespace {

Eigen::Vector3d mean_rate(const sensors::ImuSeries& imu, bool gyro) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& s : imu) sum += gyro ? s.dtheta : s.dvel;
  return sum / (static_cast<double>(imu.size()) * imu.interval.seconds());
}

double path_length(const Series<sensors::GnssSample>& gnss) {
  double length = 0.0;
  for (std::size_t i = 1; i < gnss.size(); ++i) {
    length += geodesy::wgs84.ned_difference(gnss[i - 1].position, gnss[i].position).head<2>().norm();
  }
  return length;
}

TEST(RealRecordings, CarRtkDrive) {
  VERSINE_NEEDS(folder, "car-rtk-drive");
  ImuFile imu;
  imu.table.path = folder / "drive_0708_imu_1934_gpst.csv.zst";
  imu.table.columns = {{"tow_s", "tow_s_gpst"}};
  imu.table.clock.gps_week = 2374;
  imu.table.clock.offset_s = -0.125;
  imu.axes = "backward-right-up";
  const auto read = read_imu(imu);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series.size(), 54858u);
  EXPECT_EQ(read->series.scale, TimeScale::gps);
  EXPECT_EQ(read->series.interval.ns, 10'000'000);
  EXPECT_EQ(read->series.front().time, gps_time(2374, Duration{243'261'729'000'000}));
  EXPECT_NEAR(mean_rate(read->series, false).z(), -9.8, 0.3);
  GnssFile gnss;
  gnss.table.path = folder / "drive_0708_gnss_1934_sf.pos.zst";
  const auto fixes = read_gnss(gnss);
  ASSERT_TRUE(fixes) << fixes.error().message();
  EXPECT_EQ(fixes->series.size(), 2197u);
  EXPECT_EQ(std::count_if(fixes->series.begin(), fixes->series.end(),
                          [](const auto& s) { return s.fix == sensors::FixType::fixed; }),
            2189);
  EXPECT_EQ(fixes->series.front().time, gps_time(2374, Duration{243'258'499'000'000}));
  EXPECT_NEAR(path_length(fixes->series), 4050.0, 20.0);
  ASSERT_TRUE(fixes->series.front().v_ned);
  EXPECT_DOUBLE_EQ(fixes->series.front().v_ned->z(), -0.009);
}

TEST(RealRecordings, RingLaser) {
  VERSINE_NEEDS(folder, "ring-laser-static");
  ImuFile imu;
  imu.table.path = folder / "lasergyro.imu.zst";
  imu.table.skip_lines = 13;
  imu.table.columns = {{"dtheta_x_arcsec", "1"}, {"dtheta_y_arcsec", "2"}, {"dtheta_z_arcsec", "3"},
                       {"dvel_x_ugs", "4"},      {"dvel_y_ugs", "5"},      {"dvel_z_ugs", "6"}};
  imu.gyro_scale = 0.1;
  imu.accel_scale = 125.0;
  imu.axes = "right-forward-up";
  imu.rate_hz = 100.0;
  const auto read = read_imu(imu);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series.size(), 184719u);
  const Eigen::Vector3d rate = mean_rate(read->series, true), force = mean_rate(read->series, false);
  EXPECT_NEAR(-rate.z() / units::deg_per_hour, 8.464, 0.15);  // vertical Earth rate at 34.246 deg
  EXPECT_NEAR(force.z(), -9.8, 0.05);
}

TEST(RealRecordings, CarSpeedometer) {
  VERSINE_NEEDS(folder, "car-speedometer");
  ImuFile imu;
  imu.table.path = folder / "imu.csv.zst";
  const auto read = read_imu(imu);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series.scale, TimeScale::recorder);
  EXPECT_NEAR(mean_rate(read->series, false).z(), -9.8, 0.1);
  GnssFile gnss;
  gnss.table.path = folder / "gnss.csv.zst";
  gnss.frame.origin = {50.0 * units::deg, 10.0 * units::deg, 100.0};
  gnss.sigma_range = 1.0;
  const auto fixes = read_gnss(gnss);
  ASSERT_TRUE(fixes) << fixes.error().message();
  EXPECT_NEAR(path_length(fixes->series), 2261.5, 1.0);
  SpeedFile speed;
  speed.table.path = folder / "speedometer.csv.zst";
  const auto speeds = read_speed(speed);
  ASSERT_TRUE(speeds) << speeds.error().message();
  double distance = 0.0;
  for (std::size_t i = 1; i < speeds->series.size(); ++i) {
    distance += speeds->series[i].speed * (speeds->series[i].time - speeds->series[i - 1].time).seconds();
  }
  EXPECT_NEAR(distance, 2265.2, 1.0);
}

TEST(RealRecordings, CarSpan) {
  VERSINE_NEEDS(folder, "car-span");
  ImuFile imu;
  imu.table.path = folder / "20220320_11_imu.csv.zst";
  imu.table.columns = {{"gyro_x_radps", "gyr_r_radps"}, {"gyro_y_radps", "gyr_f_radps"},
                       {"gyro_z_radps", "gyr_u_radps"}, {"accel_x_mps2", "acc_r_mps2"},
                       {"accel_y_mps2", "acc_f_mps2"},  {"accel_z_mps2", "acc_u_mps2"}};
  imu.axes = "right-forward-up";
  const auto read = read_imu(imu);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->series.front().time, gps_time(2202, Duration{17'024'911'000'000}));
  GnssFile gnss;
  gnss.table.path = folder / "20220320_11_gnss.csv.zst";
  gnss.table.columns = {{"satellites", "n_sat"},
                        {"velocity_east_mps", "v1_mps"},
                        {"velocity_north_mps", "v2_mps"},
                        {"velocity_up_mps", "v3_mps"},
                        {"sigma_north_m", "pos_std1_m"},
                        {"sigma_east_m", "pos_std2_m"},
                        {"sigma_down_m", "pos_std3_m"},
                        {"sigma_velocity_east_mps", "vel_std1_mps"},
                        {"sigma_velocity_north_mps", "vel_std2_mps"},
                        {"sigma_velocity_up_mps", "vel_std3_mps"}};
  const auto fixes = read_gnss(gnss);
  ASSERT_TRUE(fixes) << fixes.error().message();
  EXPECT_EQ(fixes->series.size(), 9841u);
  EXPECT_NEAR(fixes->series.front().position.latitude, 0.7016651, 1e-12);
}

}  // namespace
}  // namespace versine::io
