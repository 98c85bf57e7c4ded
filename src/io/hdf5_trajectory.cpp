// SPDX-License-Identifier: Apache-2.0
#include "hdf5_trajectory.hpp"

#include <array>

#include "trajectory_columns.hpp"

namespace versine::io {

namespace {
const char* epoch_of(TimeScale scale) {
  switch (scale) {
    case TimeScale::gps:
      return "1980-01-06 00:00:00 GPS time";
    case TimeScale::utc:
      return "1970-01-01 00:00:00 UTC, leap seconds not counted";
    case TimeScale::recorder:
      return "recorder's own clock";
  }
  return "";
}
}  // namespace

void write_times(Hdf5File& file, const std::string& name, const std::vector<std::int64_t>& nanoseconds,
                 TimeScale scale) {
  file.write(name, nanoseconds, "ns");
  file.attribute(name, "epoch", epoch_of(scale));
}

void write_trajectory_group(Hdf5File& file, const std::string& group, const geodesy::Trajectory& trajectory,
                            const TrajectoryOutput& output) {
  const auto chosen = decimated(trajectory, output.interval);
  const auto columns = trajectory_columns(output.projection != nullptr);
  file.group(group);
  file.attribute(group, "origin", trajectory.origin);
  file.attribute(group, "ellipsoid", "WGS84");
  if (output.projection != nullptr) file.attribute(group, "crs", output.projection->definition());
  write_times(file, group + "/time_ns", chosen, trajectory.scale, [&](std::size_t i) { return trajectory[i].time; });
  // Column by column would compute the angles and map coordinates of a point once per column.
  std::vector<std::vector<double>> values(columns.size());
  for (auto& column : values) column.reserve(chosen.size());
  std::array<std::vector<double>, 4> q;
  for (const std::size_t i : chosen) {
    const geodesy::TrajectoryPoint& point = trajectory[i];
    const PointView view = view_of(point, output.projection);
    for (std::size_t c = 0; c < columns.size(); ++c) values[c].push_back(columns[c].value(point, view));
    const double parts[] = {point.q_nb.w(), point.q_nb.x(), point.q_nb.y(), point.q_nb.z()};
    for (std::size_t k = 0; k < 4; ++k) q[k].push_back(parts[k]);
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    file.write(group + "/" + columns[c].name, values[c], columns[c].unit);
  }
  const char* names[] = {"q_nb_w", "q_nb_x", "q_nb_y", "q_nb_z"};
  for (std::size_t k = 0; k < 4; ++k) file.write(group + "/" + names[k], q[k], "1");
}

}  // namespace versine::io
