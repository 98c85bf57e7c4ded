// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "versine/app/config.hpp"
#include "versine/io/recording_description.hpp"
#include "versine/sensors/imu_grade.hpp"

/// The tables of a job file that say how a recording is to be read, shared by all jobs that read one. Each `describe`
/// fills the io description of its file; a sensor whose table is absent has an empty path.
namespace versine::app {

/// A recording's file as the job names it.
template <class Description>
struct FileConfig {
  InputPath file;
  Description description;
  [[nodiscard]] bool given() const { return !file.empty(); }
};

using ImuFileConfig = FileConfig<io::ImuFile>;
using GnssFileConfig = FileConfig<io::GnssFile>;
using OdometerFileConfig = FileConfig<io::OdometerFile>;
using SpeedFileConfig = FileConfig<io::SpeedFile>;
using GaugeFileConfig = FileConfig<io::GaugeFile>;
using RangeFileConfig = FileConfig<io::RangeFile>;
using HeadingFileConfig = FileConfig<io::HeadingFile>;
using LandmarkFileConfig = FileConfig<io::LandmarkFile>;
using TrajectoryFileConfig = FileConfig<io::TrajectoryFile>;

/// Keys inside the sensor's table; the caller opens `[imu]` and so on, and adds its own keys there.
void describe(ConfigVisitor& v, ImuFileConfig& c);
void describe(ConfigVisitor& v, GnssFileConfig& c);
void describe(ConfigVisitor& v, OdometerFileConfig& c);
void describe(ConfigVisitor& v, SpeedFileConfig& c);
void describe(ConfigVisitor& v, GaugeFileConfig& c);
void describe(ConfigVisitor& v, RangeFileConfig& c);
void describe(ConfigVisitor& v, HeadingFileConfig& c);
void describe(ConfigVisitor& v, LandmarkFileConfig& c);
void describe(ConfigVisitor& v, TrajectoryFileConfig& c);

/// An instrument's errors: a grade by name, single values overriding it.
struct ImuErrorsConfig {
  std::string grade = "navigation-rlg";
  struct Triad {
    std::optional<double> bias, random_walk, bias_instability, correlation_time, rate_random_walk, scale_factor,
        misalignment;
  } gyro, accelerometer;

  /// The grade with the overrides. Fails on an unknown grade, naming the nearest.
  [[nodiscard]] Expected<sensors::ImuErrors> errors() const;
};
void describe(ConfigVisitor& v, ImuErrorsConfig& c);

}  // namespace versine::app
