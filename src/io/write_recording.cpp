// SPDX-License-Identifier: Apache-2.0
#include "versine/io/write_recording.hpp"

#include <cmath>

#include "hdf5_file.hpp"
#include "text_output.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/io/control_points.hpp"
#include "versine/io/table_reader.hpp"
#include "versine/io/total_station_readings.hpp"
#include "versine/io/write_positions.hpp"

namespace versine::io {

namespace {
using simulation::SimulatedRecording;

Expected<void> write_imu(const std::filesystem::path& path, const sensors::ImuSeries& imu, bool rates) {
  TextOutput out(path);
  out.text(rates ? "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2"
                 : "time_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_mps,dvel_y_mps,dvel_z_mps");
  out.end_line();
  const double factor = rates ? 1.0 / imu.interval.seconds() : 1.0;
  for (const auto& s : imu) {
    const Eigen::Vector3d g = factor * s.dtheta, a = factor * s.dvel;
    out.print("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", seconds_text(s.time), g.x(), g.y(), g.z(), a.x(),
              a.y(), a.z());
  }
  return out.close();
}

Expected<void> write_control(const std::filesystem::path& path, const SimulatedRecording& r) {
  const geodesy::LocalFrame frame(r.origin);
  std::vector<ControlEntry> entries;
  for (const auto& p : r.control_points) {
    entries.push_back({p.name, frame.to_geodetic(p.position), p.covariance.diagonal().cwiseSqrt()});
  }
  return write_control_points(path, entries);
}

template <class Samples, class Row>
Expected<void> write_signal(const std::filesystem::path& path, std::string_view header, const Samples& samples,
                            const Row& row) {
  TextOutput out(path);
  out.text(header);
  out.end_line();
  for (const auto& s : samples) row(out, s);
  return out.close();
}
}  // namespace

Expected<std::vector<std::string>> write_recording(const std::filesystem::path& folder, const SimulatedRecording& r,
                                                   const RecordingOutput& output) {
  std::vector<std::string> names;
  Expected<void> done;
  // Writes a file if there is something for it and all went well so far.
  const auto put = [&](bool there, const std::string& name, const auto& write) {
    if (!there || !done) return;
    done = write(folder / name);
    names.push_back(name);
  };
  put(!r.imu.empty(), "imu.csv", [&](const auto& path) { return write_imu(path, r.imu, output.imu_rates); });
  for (std::size_t i = 0; i < r.odometers.size(); ++i) {
    put(!r.odometers[i].empty(), fmt::format("odometer_{}.csv", i + 1), [&](const auto& path) {
      return write_signal(path, "time_s,distance_m", r.odometers[i], [](TextOutput& out, const auto& s) {
        out.print("{},{:.6f}\n", seconds_text(s.time), s.distance);
      });
    });
  }
  put(!r.gauge.empty(), "gauge.csv", [&](const auto& path) {
    return write_signal(path, "time_s,gauge_mm,temperature_degc", r.gauge, [](TextOutput& out, const auto& s) {
      out.print("{},{:.4f},{:.2f}\n", seconds_text(s.time), s.reading / units::mm, s.temperature);
    });
  });
  put(!r.sleeper.empty(), "sleeper.csv", [&](const auto& path) {
    return write_signal(path, "time_s,range_m", r.sleeper, [](TextOutput& out, const auto& s) {
      out.print("{},{:.4f}\n", seconds_text(s.time), s.range);
    });
  });
  put(!r.gnss.empty(), "gnss.csv", [&](const auto& path) { return write_gnss_csv(path, r.gnss); });
  put(!r.landmarks.empty(), "landmarks.csv", [&](const auto& path) { return write_landmarks_csv(path, r.landmarks); });
  put(!r.control_points.empty(), "control.csv", [&](const auto& path) { return write_control(path, r); });
  put(!r.stationings.empty(), "readings.csv",
      [&](const auto& path) { return write_total_station(path, r.stationings); });
  put(!r.axle_box.vertical.empty(), "axle_box.h5", [&](const auto& path) {
    auto file = Hdf5File::create(path);
    if (!file) return Expected<void>(tl::unexpected(std::move(file.error())));
    file->write("start_ns", std::vector<std::int64_t>{r.axle_box.start.ns}, "ns");
    file->write("rate_hz", std::vector<double>{r.axle_box.rate}, "Hz");
    file->write("vertical_mps2", r.axle_box.vertical, "m/s^2");
    return file->close();
  });
  if (!done) return tl::unexpected(std::move(done.error()));
  return names;
}

Expected<simulation::Deviations> read_deviations(const std::filesystem::path& path) {
  auto lines = LineReader::open(path);
  if (!lines) return tl::unexpected(std::move(lines.error()));
  auto table = TableReader::open(std::move(*lines), {.path = path});
  if (!table) return tl::unexpected(std::move(table.error()));
  const auto distance = table->need("distance", Quantity::length);
  if (!distance) return tl::unexpected(distance.error());
  simulation::Deviations d;
  std::vector<std::pair<TableReader::Slot, std::vector<double>*>> columns;
  for (const auto& [name, values] : {std::pair{"level", &d.level}, std::pair{"alignment", &d.alignment},
                                     std::pair{"cross_level", &d.cross_level}, std::pair{"gauge", &d.gauge}}) {
    const auto slot = table->find(name, Quantity::length);
    if (!slot) return tl::unexpected(slot.error());
    if (*slot) columns.emplace_back(**slot, values);
  }
  std::size_t rows = 0;
  for (; table->next(); ++rows) {
    const double at = table->number(*distance);
    if (rows == 0) d.begin = at;
    if (rows == 1) d.step = at - d.begin;
    if (!(std::abs(at - d.begin - static_cast<double>(rows) * (rows > 0 ? d.step : 0.0)) <= 1e-6) || !(d.step > 0.0)) {
      return tl::unexpected(table->complaint(*distance, fmt::format("{} m", at), "distances at a fixed step",
                                             "resample the table to one step"));
    }
    for (const auto& [slot, values] : columns) {
      if (!std::isfinite(table->number(slot))) {
        return tl::unexpected(table->complaint(slot, "no number", "a deviation", "give 0 where there is none"));
      }
      values->push_back(table->number(slot));
    }
  }
  if (table->error()) return tl::unexpected(*table->error());
  return d;
}

}  // namespace versine::io
