// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include "hdf5_file.hpp"
#include "trajectory_columns.hpp"
#include "versine/io/write_trajectory.hpp"

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

template <class List, class TimeOf>
void write_times(Hdf5File& file, const std::string& name, const List& list, TimeScale scale, TimeOf time_of) {
  std::vector<std::int64_t> times;
  times.reserve(list.size());
  for (const auto& item : list) times.push_back(time_of(item).ns);
  file.write(name, times, "ns");
  file.attribute(name, "epoch", epoch_of(scale));
}

void write_one(Hdf5File& file, const std::string& group, const geodesy::Trajectory& trajectory,
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

void write_sensor_errors(Hdf5File& file, const fusion::Solution& solution) {
  const std::string group = "sensor_errors";
  file.group(group);
  write_times(file, group + "/time_ns", solution.sensor_errors, solution.smoothed.scale,
              [](const fusion::SensorErrorSample& s) { return s.time; });
  for (std::size_t k = 0; k < solution.error_names.size(); ++k) {
    std::vector<float> value, sigma;
    for (const fusion::SensorErrorSample& s : solution.sensor_errors) {
      const auto at = static_cast<Eigen::Index>(k);
      const bool there = at < s.value.size() && at < s.sigma.size();
      value.push_back(there ? s.value[at] : std::numeric_limits<float>::quiet_NaN());
      sigma.push_back(there ? s.sigma[at] : std::numeric_limits<float>::quiet_NaN());
    }
    file.write(group + "/" + solution.error_names[k], value, "SI, rad");
    file.write(group + "/sigma_" + solution.error_names[k], sigma, "SI, rad");
  }
}

void write_innovations(Hdf5File& file, const fusion::Solution& solution) {
  const std::string group = "innovations";
  file.group(group);
  std::vector<std::int64_t> times, component, used;
  std::vector<std::string> sensor;
  std::vector<float> value, sigma;
  std::vector<double> nis;
  for (const fusion::Innovation& i : solution.innovations) {
    for (Eigen::Index k = 0; k < i.value.size(); ++k) {
      times.push_back(i.time.ns);
      sensor.push_back(i.sensor);
      component.push_back(k);
      value.push_back(i.value[k]);
      sigma.push_back(i.sigma[k]);
      nis.push_back(i.nis);
      used.push_back(i.used ? 1 : 0);
    }
  }
  file.write(group + "/time_ns", times, "ns");
  file.attribute(group + "/time_ns", "epoch", epoch_of(solution.smoothed.scale));
  file.write(group + "/sensor", sensor);
  file.write(group + "/component", component, "1");
  file.write(group + "/innovation", value, "SI, rad");
  file.write(group + "/sigma", sigma, "SI, rad");
  file.write(group + "/nis", nis, "1");
  file.write(group + "/used", used, "1");
}
}  // namespace

Expected<void> write_solution_hdf5(const std::filesystem::path& path, const fusion::Solution& solution,
                                   const TrajectoryOutput& output) {
  auto file = Hdf5File::create(path);
  if (!file) return tl::unexpected(file.error());
  file->attribute("/", "format", "versine trajectory 1");
  write_one(*file, "smoothed", solution.smoothed, output);
  if (!solution.forward.empty()) write_one(*file, "forward", solution.forward, output);
  if (!solution.sensor_errors.empty()) write_sensor_errors(*file, solution);
  if (!solution.innovations.empty()) write_innovations(*file, solution);
  return file->close();
}

}  // namespace versine::io
