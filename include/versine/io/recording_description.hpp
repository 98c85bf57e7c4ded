// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "versine/core/time.hpp"
#include "versine/geodesy/geodetic.hpp"

/// How each file of a recording is to be read: plain values that a job file, a program or a test fills in.
/// What stands in the files is described in docs/formats.md.
namespace versine::io {

/// The clock that stamped a file. Every series is delivered in GPS time when `scale` is gps or utc (UTC is converted
/// with the leap seconds of its date), else in the recorder's own time.
struct Clock {
  TimeScale scale = TimeScale::gps;
  std::optional<int> gps_week;  ///< week of the first `tow_s`, when the file does not tell it; roll-overs are followed
  std::string date;             ///< "2025-07-08", of the first time of day, when the file does not tell it
  double offset_s = 0.0;        ///< added to every stamp; -0.125 for stamps that are 0.125 s late
  double drift_ppm = 0.0;       ///< further added, per second since the first stamp
};

/// A text table: CSV with a header, or columns without one. gzip and zstd are recognised by their first bytes.
struct TableFile {
  std::filesystem::path path;
  /// Versine's name of a column with the unit of the file's numbers, to the file's own header or, for files without
  /// header, the column's number from 1: {"gyro_x_degps", "gyr_x_dps"}, {"dtheta_x_arcsec", "1"}. Columns that carry
  /// Versine's names already need no entry.
  std::map<std::string, std::string> columns;
  std::size_t skip_lines = 0;  ///< leading lines to pass over, comments included, before the header or the data
  std::string delimiter;       ///< one character, or "blank"; empty: found from the header
  Clock clock;
};

/// Angles, rates and increments of an inertial measurement unit.
struct ImuFile {
  enum class Format {
    csv,      ///< gyro_x.. with accel_x.. (rates) or dtheta_x.. with dvel_x.. (increments)
    kf_gins,  ///< no header: seconds of week, 3 x rad, 3 x m/s
  };
  /// What a rate stands for. Increments need no such statement.
  enum class Rate {
    mean,      ///< mean over the interval that ends at the stamp
    at_stamp,  ///< the value at the stamp
  };
  TableFile table;
  Format format = Format::csv;
  /// Where the sensor's x, y and z point: three of forward, backward, right, left, up, down, right-handed, joined by
  /// '-': "forward-right-down" (nothing to turn), "right-forward-up".
  std::string axes = "forward-right-down";
  std::optional<std::string> accel_axes;    ///< of the accelerometers, when their axes differ
  std::optional<Eigen::Matrix3d> rotation;  ///< instead of `axes`: C_bs, sensor axes to forward-right-down
  double gyro_scale = 1.0;   ///< factor from the numbers in the file to the unit in the column's name (counts)
  double accel_scale = 1.0;  ///< the same for the accelerometers
  Rate rate = Rate::mean;
  std::optional<double> rate_hz;  ///< for files without a time column: their sampling rate
  double start_s = 0.0;           ///< and the time of the first sample, s of the clock's scale
};

/// How positions are written, where that is not latitude, longitude and height.
struct PositionFrame {
  std::optional<geodesy::Geodetic> origin;  ///< of north_m, east_m, down_m (or up_m)
  std::string crs;                          ///< of easting_m, northing_m, height_m: "EPSG:25832"
};

struct GnssFile {
  enum class Format { automatic, csv, rtklib, nmea, kf_gins };
  TableFile table;
  Format format = Format::automatic;
  PositionFrame frame;
  /// Standard deviations where the file gives none: horizontal (each of north and east) and vertical, m; velocity m/s.
  std::optional<double> sigma_horizontal, sigma_vertical, sigma_velocity;
  /// Where the file gives only dilutions of precision: sigma of a range; sigma = dop * sigma_range.
  std::optional<double> sigma_range;
};

struct OdometerFile {
  TableFile table;  ///< distance_m; or count; or phase_a and phase_b (quadrature); or nothing but a time per pulse
  double metres_per_count = 0.0;  ///< of count, of a pulse, and of a quadrature step (four a period); sign matters
  int counter_bits = 0;           ///< width of a counter that wraps around; 0: does not wrap
};

struct SpeedFile {
  TableFile table;  ///< speed_mps, speed_kmh
};

struct GaugeFile {
  TableFile table;  ///< gauge_mm, temperature_degC (optional)
};

struct RangeFile {
  TableFile table;  ///< range_m, range_mm
};

struct HeadingFile {
  TableFile table;              ///< heading_deg, sigma_heading_deg
  std::optional<double> sigma;  ///< rad, where the file gives none
};

struct LandmarkFile {
  TableFile table;  ///< name, time_from_s, time_to_s, a position, sigma_*
  PositionFrame frame;
  std::optional<double> sigma_horizontal, sigma_vertical;  ///< m, where the file gives none
};

/// A trajectory of Versine (`trajectory.h5`, `trajectory.csv`) or of other software: time, position, roll, pitch,
/// heading, and where given velocity and sigmas. HDF5 is recognised by its first bytes.
struct TrajectoryFile {
  TableFile table;
  PositionFrame frame;
};

}  // namespace versine::io
