// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "hdf5_trajectory.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::io {

namespace {
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
  write_times(file, group + "/time_ns", times, solution.smoothed.scale);
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
  write_trajectory_group(*file, "smoothed", solution.smoothed, output);
  if (!solution.forward.empty()) write_trajectory_group(*file, "forward", solution.forward, output);
  if (!solution.sensor_errors.empty()) write_sensor_errors(*file, solution);
  if (!solution.innovations.empty()) write_innovations(*file, solution);
  return file->close();
}

}  // namespace versine::io
