// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "hdf5_file.hpp"
#include "position_columns.hpp"
#include "time_columns.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::io {

namespace {
using geodesy::Trajectory;
using geodesy::TrajectoryPoint;

float variance(double sigma) {
  return std::isfinite(sigma) ? static_cast<float>(sigma * sigma) : 0.0f;
}

geodesy::Covariance3 diagonal(double a, double b, double c) {
  return {.xx = variance(a), .yy = variance(b), .zz = variance(c)};
}

/// Optional columns by name; a value that is not there is NaN.
class TrajectoryColumns {
 public:
  static Expected<TrajectoryColumns> bind(TableReader& table) {
    TrajectoryColumns columns;
    const auto add = [&](const char* base, Quantity quantity) -> Expected<void> {
      const auto slot = table.find(base, quantity);
      if (!slot) return tl::unexpected(slot.error());
      columns.slot_.push_back(*slot);
      return {};
    };
    using Q = Quantity;
    for (const auto& [base, quantity] : {std::pair{"velocity_north", Q::speed},
                                         {"velocity_east", Q::speed},
                                         {"velocity_down", Q::speed},
                                         {"sigma_north", Q::length},
                                         {"sigma_east", Q::length},
                                         {"sigma_down", Q::length},
                                         {"sigma_velocity_north", Q::speed},
                                         {"sigma_velocity_east", Q::speed},
                                         {"sigma_velocity_down", Q::speed},
                                         {"sigma_tilt_north", Q::angle},
                                         {"sigma_tilt_east", Q::angle},
                                         {"sigma_heading", Q::angle},
                                         {"segment", Q::none}}) {
      if (const auto added = add(base, quantity); !added) return tl::unexpected(added.error());
    }
    return columns;
  }
  [[nodiscard]] double operator()(const TableReader& table, std::size_t i) const {
    return slot_[i] ? table.number(*slot_[i]) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  std::vector<std::optional<TableReader::Slot>> slot_;
};

Expected<Read<Trajectory>> read_text_trajectory(const TrajectoryFile& file) {
  auto lines = LineReader::open(file.table.path);
  if (!lines) return tl::unexpected(lines.error());
  const std::string name = lines->name();
  auto opened = TableReader::open(std::move(*lines), file.table);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  auto times = TimeColumns::bind(table, file.table.clock);
  if (!times) return tl::unexpected(times.error());
  const auto place = PositionColumns::bind(table, file.frame);
  if (!place) return tl::unexpected(place.error());
  std::array<TableReader::Slot, 3> angle{};
  const char* names[] = {"roll", "pitch", "heading"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto slot = table.need(names[i], Quantity::angle);
    if (!slot) return tl::unexpected(slot.error());
    angle[i] = *slot;
  }
  const auto columns = TrajectoryColumns::bind(table);
  if (!columns) return tl::unexpected(columns.error());

  Read<Trajectory> read;
  while (table.next()) {
    const auto time = times->read(table);
    if (!time) return tl::unexpected(time.error());
    const auto position = place->read(table);
    if (!position) return tl::unexpected(position.error());
    const geodesy::Euler euler{table.number(angle[0]), table.number(angle[1]), table.number(angle[2])};
    if (!*time || !*position || !std::isfinite(euler.roll + euler.pitch + euler.yaw)) {
      table.faults().add("not a number", table.line_number(), "");
      continue;
    }
    const auto x = [&](std::size_t i) { return (*columns)(table, i); };
    TrajectoryPoint p;
    p.time = **time;
    p.position = **position;
    p.q_nb = geodesy::to_quaternion(euler);
    const Eigen::Vector3d v(x(0), x(1), x(2));
    if (v.allFinite()) p.v_eb_n = v;
    p.position_covariance = diagonal(x(3), x(4), x(5));
    p.velocity_covariance = diagonal(x(6), x(7), x(8));
    p.attitude_covariance = diagonal(x(9), x(10), x(11));
    if (x(12) >= 0.0 && x(12) < 1e9) p.segment = static_cast<std::int32_t>(x(12));
    table.faults().now(p.time);
    read.series.samples.push_back(p);
  }
  if (table.error()) return fail(*table.error());
  if (const auto fine = table.faults().tolerable(name, read.series.size()); !fine) return tl::unexpected(fine.error());
  table.faults().report("trajectory", read.record);
  read.series.scale = times->scale();
  read.series.origin = file.table.path.filename().string();
  return read;
}

Expected<Read<Trajectory>> read_hdf5_trajectory(const TrajectoryFile& file) {
  auto opened = Hdf5File::open(file.table.path);
  if (!opened) return tl::unexpected(opened.error());
  const Hdf5File& h5 = *opened;
  const std::string group = "smoothed/";
  const auto wrong = [&](std::string found) {
    return fail({.file = file.table.path.string(),
                 .field = group,
                 .found = std::move(found),
                 .expected = "a trajectory of Versine (docs/formats.md)",
                 .advice = "name a trajectory.h5 of a survey result"});
  };
  if (!h5.has("smoothed")) return wrong("no group 'smoothed'");
  const auto times = h5.integers(group + "time_ns");
  if (!times) return wrong("no dataset time_ns");
  Read<Trajectory> read;
  read.series.samples.resize(times->size());
  bool complete = true;
  const auto column = [&](const char* name, auto set) {
    const auto values = h5.doubles(group + name);
    if (!values || values->size() != times->size()) {
      complete = false;
      return;
    }
    for (std::size_t i = 0; i < values->size(); ++i) set(read.series.samples[i], (*values)[i]);
  };
  using T = TrajectoryPoint;
  for (std::size_t i = 0; i < times->size(); ++i) read.series.samples[i].time = {(*times)[i]};
  column("latitude_deg", [](T& p, double x) { p.position.latitude = x * units::deg; });
  column("longitude_deg", [](T& p, double x) { p.position.longitude = x * units::deg; });
  column("height_m", [](T& p, double x) { p.position.height = x; });
  column("velocity_north_mps", [](T& p, double x) { p.v_eb_n.x() = x; });
  column("velocity_east_mps", [](T& p, double x) { p.v_eb_n.y() = x; });
  column("velocity_down_mps", [](T& p, double x) { p.v_eb_n.z() = x; });
  column("q_nb_w", [](T& p, double x) { p.q_nb.w() = x; });
  column("q_nb_x", [](T& p, double x) { p.q_nb.x() = x; });
  column("q_nb_y", [](T& p, double x) { p.q_nb.y() = x; });
  column("q_nb_z", [](T& p, double x) { p.q_nb.z() = x; });
  column("sigma_north_m", [](T& p, double x) { p.position_covariance.xx = variance(x); });
  column("sigma_east_m", [](T& p, double x) { p.position_covariance.yy = variance(x); });
  column("sigma_down_m", [](T& p, double x) { p.position_covariance.zz = variance(x); });
  column("sigma_velocity_north_mps", [](T& p, double x) { p.velocity_covariance.xx = variance(x); });
  column("sigma_velocity_east_mps", [](T& p, double x) { p.velocity_covariance.yy = variance(x); });
  column("sigma_velocity_down_mps", [](T& p, double x) { p.velocity_covariance.zz = variance(x); });
  column("sigma_tilt_north_deg", [](T& p, double x) { p.attitude_covariance.xx = variance(x * units::deg); });
  column("sigma_tilt_east_deg", [](T& p, double x) { p.attitude_covariance.yy = variance(x * units::deg); });
  column("sigma_heading_deg", [](T& p, double x) { p.attitude_covariance.zz = variance(x * units::deg); });
  column("segment", [](T& p, double x) { p.segment = x >= 0.0 && x < 1e9 ? static_cast<std::int32_t>(x) : 0; });
  if (!complete) return wrong("datasets missing or of different length");
  const std::string epoch = h5.text_attribute(group + "time_ns", "epoch");
  read.series.scale = epoch.starts_with("1980")   ? TimeScale::gps
                      : epoch.starts_with("1970") ? TimeScale::utc
                                                  : TimeScale::recorder;
  read.series.origin = h5.text_attribute("smoothed", "origin");
  return read;
}
}  // namespace

Expected<Read<Trajectory>> read_trajectory(const TrajectoryFile& file) {
  std::ifstream stream(file.table.path, std::ios::binary);
  char mark[8] = {};
  stream.read(mark, sizeof mark);
  if (std::string_view(mark, sizeof mark) == std::string_view("\x89HDF\r\n\x1a\n", 8))
    return read_hdf5_trajectory(file);
  return read_text_trajectory(file);
}

}  // namespace versine::io
