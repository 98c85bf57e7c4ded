// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "axes.hpp"
#include "read_from.hpp"
#include "time_columns.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::io {

namespace {
using sensors::ImuContent;
using sensors::ImuSeries;

/// Where x, y and z of a triad stand in the table.
struct Triad {
  std::array<TableReader::Slot, 3> slot{};
  [[nodiscard]] Eigen::Vector3d read(const TableReader& table) const {
    return {table.number(slot[0]), table.number(slot[1]), table.number(slot[2])};
  }
};

Expected<Triad> bind(TableReader& table, const std::string& base, Quantity quantity, double scale) {
  Triad triad;
  const char* axis[] = {"_x", "_y", "_z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto slot = table.need(base + axis[i], quantity, scale);
    if (!slot) return tl::unexpected(slot.error());
    triad.slot[i] = *slot;
  }
  return triad;
}

struct Columns {
  Triad gyro, accel;
  bool rates = false;
};

Expected<Columns> bind_columns(TableReader& table, const ImuFile& file) {
  Columns columns;
  const bool increments = table.has("dtheta_x") || table.has("dvel_x");
  columns.rates = !increments;
  const auto gyro = increments ? bind(table, "dtheta", Quantity::angle, file.gyro_scale)
                               : bind(table, "gyro", Quantity::angular_rate, file.gyro_scale);
  if (!gyro) return tl::unexpected(gyro.error());
  const auto accel = increments ? bind(table, "dvel", Quantity::speed, file.accel_scale)
                                : bind(table, "accel", Quantity::acceleration, file.accel_scale);
  if (!accel) return tl::unexpected(accel.error());
  columns.gyro = *gyro;
  columns.accel = *accel;
  return columns;
}

struct Rotation {
  Eigen::Matrix3d gyro, accel;
};

Expected<Rotation> rotation_of(const ImuFile& file, const std::string& name) {
  const auto C = file.rotation ? axes_from_matrix(*file.rotation, name) : axes_from_words(file.axes, name);
  if (!C) return tl::unexpected(C.error());
  const auto A = file.accel_axes ? axes_from_words(*file.accel_axes, name) : C;
  if (!A) return tl::unexpected(A.error());
  return Rotation{*C, *A};
}

// Median difference of the stamps; the first 10,000 samples tell it.
Duration nominal_interval(const ImuSeries& series) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < series.size() && steps.size() < 10000; ++i) {
    const std::int64_t step = (series[i].time - series[i - 1].time).ns;
    if (step > 0) steps.push_back(step);
  }
  if (steps.empty()) return {};
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return {*middle};
}

ImuFile with_layout(ImuFile file) {
  if (file.format == ImuFile::Format::kf_gins && file.table.columns.empty()) {
    file.table.columns = {{"tow_s", "1"},      {"dtheta_x_rad", "2"}, {"dtheta_y_rad", "3"}, {"dtheta_z_rad", "4"},
                          {"dvel_x_mps", "5"}, {"dvel_y_mps", "6"},   {"dvel_z_mps", "7"}};
  }
  return file;
}
}  // namespace

Expected<Read<ImuSeries>> read_imu_from(LineReader lines, const ImuFile& given) {
  const ImuFile file = with_layout(given);
  const std::string name = lines.name();
  const auto rotation = rotation_of(file, name);
  if (!rotation) return tl::unexpected(rotation.error());
  auto opened = TableReader::open(std::move(lines), file.table);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  const auto columns = bind_columns(table, file);
  if (!columns) return tl::unexpected(columns.error());

  Read<ImuSeries> read;
  ImuSeries& series = read.series;
  std::optional<TimeColumns> times;
  if (file.rate_hz) {
    if (!(*file.rate_hz > 0.0)) {
      return fail({.file = name,
                   .field = "rate_hz",
                   .found = "no positive rate",
                   .expected = "samples per second",
                   .advice = "set rate_hz"});
    }
  } else {
    auto bound = TimeColumns::bind(table, file.table.clock);
    if (!bound) {
      Error error = bound.error();
      error.advice += "; a file without times needs rate_hz";
      return fail(error);
    }
    times = std::move(*bound);
  }
  ClockCorrection correction(file.table.clock);
  const Time start = Time::from_seconds(file.start_s);
  std::int64_t count = 0;
  while (table.next()) {
    Time time;
    if (times) {
      const auto t = times->read(table);
      if (!t) return tl::unexpected(t.error());
      if (!*t) {
        table.faults().add("no time", table.line_number(), "");
        continue;
      }
      time = **t;
    } else {
      // From the sample's number, so that nothing adds up.
      const auto ns = std::llround(static_cast<double>(count) / *file.rate_hz * 1e9);
      time = correction(start + Duration{ns});
    }
    ++count;
    const Eigen::Vector3d gyro = rotation->gyro * columns->gyro.read(table);
    const Eigen::Vector3d accel = rotation->accel * columns->accel.read(table);
    if (!(gyro + accel).allFinite()) {
      table.faults().add("not a number", table.line_number(), "");
      continue;
    }
    table.faults().now(time);
    series.samples.push_back({time, gyro, accel});
  }
  if (table.error()) return fail(*table.error());
  if (const auto fine = table.faults().tolerable(name, series.size()); !fine) return tl::unexpected(fine.error());
  table.faults().report("imu", read.record);
  series.scale = times                                                                 ? times->scale()
                 : file.table.clock.scale == TimeScale::recorder || file.start_s < 1e8 ? TimeScale::recorder
                                                                                       : TimeScale::gps;
  series.interval = nominal_interval(series);
  if (file.rate_hz) series.interval = Duration::from_seconds(1.0 / *file.rate_hz);
  if (columns->rates) {
    series.content = file.rate == ImuFile::Rate::mean ? ImuContent::mean_rates : ImuContent::rates_at_stamp;
    const double interval = series.interval.seconds();
    for (auto& sample : series.samples) sample.dtheta *= interval, sample.dvel *= interval;
  }
  return read;
}

Expected<Read<ImuSeries>> read_imu(const ImuFile& file) {
  auto lines = LineReader::open(file.table.path);
  if (!lines) return tl::unexpected(lines.error());
  return read_imu_from(std::move(*lines), file);
}

}  // namespace versine::io
