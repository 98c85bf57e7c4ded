// SPDX-License-Identifier: Apache-2.0
#include "versine/sensors/imu_grade.hpp"

#include <algorithm>
#include <array>

#include "versine/core/units.hpp"

namespace versine::sensors {

namespace {
using namespace units;

constexpr std::array grades{
    ImuGrade{"perfect", "no errors at all: to test geometry and mechanisation", {}},
    ImuGrade{"navigation-rlg",
             "ring-laser gyro of a track trolley: Chen 2018 table 1 (0.01 deg/h, 25 mGal, 10 ppm); random walks and "
             "instability of the same class, Jiang 2017 section 6.1 (0.005 deg/sqrt(h))",
             {.gyro = {.bias = 0.01 * deg_per_hour,
                       .random_walk = 0.005 * deg_per_sqrt_hour,
                       .bias_instability = 0.003 * deg_per_hour,
                       .correlation_time = 4 * hour,
                       .scale_factor = 10 * ppm,
                       .misalignment = 3 * arcsec},
              .accelerometer = {.bias = 25 * mGal,
                                .random_walk = 0.001 * mps_per_sqrt_hour,
                                .bias_instability = 5 * mGal,
                                .correlation_time = 4 * hour,
                                .scale_factor = 10 * ppm,
                                .misalignment = 3 * arcsec}}},
    ImuGrade{"rlg-jiang",
             "ring-laser gyro of Jiang 2017 section 6.1: 0.03 deg/h, 0.005 deg/sqrt(h)",
             {.gyro = {.bias = 0.03 * deg_per_hour,
                       .random_walk = 0.005 * deg_per_sqrt_hour,
                       .bias_instability = 0.003 * deg_per_hour,
                       .correlation_time = 4 * hour,
                       .scale_factor = 10 * ppm,
                       .misalignment = 3 * arcsec},
              .accelerometer = {.bias = 50 * mGal,
                                .random_walk = 0.003 * mps_per_sqrt_hour,
                                .bias_instability = 10 * mGal,
                                .correlation_time = 4 * hour,
                                .scale_factor = 30 * ppm,
                                .misalignment = 5 * arcsec}}},
    ImuGrade{"fog",
             "fibre-optic gyro: 0.1 deg/h, 0.007 deg/sqrt(h) (Jiang 2017 section 6.1)",
             {.gyro = {.bias = 0.1 * deg_per_hour,
                       .random_walk = 0.007 * deg_per_sqrt_hour,
                       .bias_instability = 0.03 * deg_per_hour,
                       .correlation_time = 1 * hour,
                       .scale_factor = 50 * ppm,
                       .misalignment = 10 * arcsec},
              .accelerometer = {.bias = 100 * mGal,
                                .random_walk = 0.01 * mps_per_sqrt_hour,
                                .bias_instability = 20 * mGal,
                                .correlation_time = 1 * hour,
                                .scale_factor = 100 * ppm,
                                .misalignment = 10 * arcsec}}},
    ImuGrade{"tactical",
             "tactical-grade MEMS or small FOG: 1 deg/h in-run, 0.1 deg/sqrt(h), 1 mg (typical data sheets)",
             {.gyro = {.bias = 5 * deg_per_hour,
                       .random_walk = 0.1 * deg_per_sqrt_hour,
                       .bias_instability = 1 * deg_per_hour,
                       .correlation_time = 1000,
                       .scale_factor = 300 * ppm,
                       .misalignment = 100 * arcsec},
              .accelerometer = {.bias = 1000 * mGal,
                                .random_walk = 0.03 * mps_per_sqrt_hour,
                                .bias_instability = 50 * mGal,
                                .correlation_time = 1000,
                                .scale_factor = 300 * ppm,
                                .misalignment = 100 * arcsec}}},
    ImuGrade{"mems",
             "consumer MEMS: 10 deg/h in-run, 0.3 deg/sqrt(h), 10 mg (typical data sheets)",
             {.gyro = {.bias = 360 * deg_per_hour,
                       .random_walk = 0.3 * deg_per_sqrt_hour,
                       .bias_instability = 10 * deg_per_hour,
                       .correlation_time = 500,
                       .scale_factor = 3000 * ppm,
                       .misalignment = 1000 * arcsec},
              .accelerometer = {.bias = 10000 * mGal,
                                .random_walk = 0.06 * mps_per_sqrt_hour,
                                .bias_instability = 100 * mGal,
                                .correlation_time = 500,
                                .scale_factor = 3000 * ppm,
                                .misalignment = 1000 * arcsec}}},
};
}  // namespace

std::span<const ImuGrade> imu_grades() {
  return grades;
}

std::optional<ImuGrade> find_imu_grade(std::string_view name) {
  const auto it = std::find_if(grades.begin(), grades.end(), [&](const ImuGrade& g) { return g.name == name; });
  return it == grades.end() ? std::nullopt : std::optional(*it);
}

}  // namespace versine::sensors
