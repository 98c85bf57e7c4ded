// SPDX-License-Identifier: Apache-2.0
#include "hdf5_trajectory.hpp"
#include "text_output.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/write_recording.hpp"

namespace versine::io {

namespace {
using simulation::Truth;

template <class List, class Value>
std::vector<double> gather(const List& list, const Value& value) {
  std::vector<double> out;
  out.reserve(list.size());
  for (const auto& item : list) out.push_back(value(item));
  return out;
}

/// What is known by distance: rails and sleepers.
void write_line(Hdf5File& file, const Truth& t) {
  const auto& r = t.rails;
  if (!r.distance.empty()) {
    file.group("rails");
    file.write("rails/distance_m", r.distance, "m");
    file.write("rails/mileage_m", r.mileage, "m");
    for (const auto& [side, rail] : {std::pair{"left", &r.left}, std::pair{"right", &r.right}}) {
      const std::string name = std::string("rails/") + side;
      file.write(name + "_latitude_deg", gather(*rail, [](const auto& g) { return g.latitude / units::deg; }), "deg");
      file.write(name + "_longitude_deg", gather(*rail, [](const auto& g) { return g.longitude / units::deg; }), "deg");
      file.write(name + "_height_m", gather(*rail, [](const auto& g) { return g.height; }), "m");
    }
    file.write("rails/gauge_m", r.gauge, "m");
    file.write("rails/cross_level_m", r.cross_level, "m");
    file.write("rails/level_m", r.level, "m");
    file.write("rails/alignment_m", r.alignment, "m");
  }
  file.group("sleepers");
  file.write("sleepers/distance_m", t.sleepers, "m");
}

/// The errors that were put into the sensors.
void write_errors(Hdf5File& file, const Truth& t) {
  if (!t.bias.empty()) {
    file.group("imu_bias");
    write_times(file, "imu_bias/time_ns", t.bias, t.trajectory.scale, [](const auto& s) { return s.time; });
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      file.write("imu_bias/gyro_" + axis + "_radps", gather(t.bias, [&](const auto& s) { return s.dtheta(i); }),
                 "rad/s");
      file.write("imu_bias/accel_" + axis + "_mps2", gather(t.bias, [&](const auto& s) { return s.dvel(i); }), "m/s^2");
    }
  }
  file.group("constants");
  for (const auto& [name, value] : t.constants) {
    file.write("constants/" + name, std::vector<double>{value}, "SI, rad");
  }
}

Expected<void> write_hdf5(const std::filesystem::path& path, const Truth& t) {
  auto file = Hdf5File::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  file->attribute("/", "format", "versine truth 1");
  // As a survey's result, so that whatever reads one reads the other.
  write_trajectory_group(*file, "smoothed", t.trajectory, {});
  file->group("progress");
  write_times(*file, "progress/time_ns", t.progress, t.trajectory.scale, [](const auto& p) { return p.time; });
  file->write("progress/distance_m", gather(t.progress, [](const auto& p) { return p.distance; }), "m");
  file->write("progress/mileage_m", gather(t.progress, [](const auto& p) { return p.mileage; }), "m");
  file->write("progress/speed_mps", gather(t.progress, [](const auto& p) { return p.speed; }), "m/s");
  write_line(*file, t);
  write_errors(*file, t);
  return file->close();
}

Expected<void> write_trajectory(const std::filesystem::path& path, const Truth& t) {
  TextOutput out(path);
  out.text(
      "time_s,latitude_deg,longitude_deg,height_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,"
      "roll_deg,pitch_deg,heading_deg,distance_m,mileage_m,speed_mps,track,track_distance_m");
  out.end_line();
  for (std::size_t i = 0; i < t.trajectory.size(); ++i) {
    const auto& p = t.trajectory[i];
    const auto& at = t.progress[i];
    const geodesy::Euler e = geodesy::to_euler(p.q_nb);
    out.print("{},{:.12f},{:.12f},{:.6f},{:.7f},{:.7f},{:.7f},{:.8f},{:.8f},{:.8f},{:.6f},{:.6f},{:.7f},{},{:.6f}\n",
              seconds_text(p.time), p.position.latitude / units::deg, p.position.longitude / units::deg,
              p.position.height, p.v_eb_n.x(), p.v_eb_n.y(), p.v_eb_n.z(), e.roll / units::deg, e.pitch / units::deg,
              e.yaw / units::deg, at.distance, at.mileage, at.speed, at.track, at.track_distance);
  }
  return out.close();
}

Expected<void> write_rails(const std::filesystem::path& path, const simulation::RailTruth& r) {
  TextOutput out(path);
  out.text(
      "distance_m,mileage_m,left_latitude_deg,left_longitude_deg,left_height_m,right_latitude_deg,"
      "right_longitude_deg,right_height_m,gauge_mm,cross_level_mm,level_mm,alignment_mm");
  out.end_line();
  for (std::size_t i = 0; i < r.distance.size(); ++i) {
    const auto &a = r.left[i], &b = r.right[i];
    out.print("{:.4f},{:.4f},{:.12f},{:.12f},{:.6f},{:.12f},{:.12f},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f}\n",
              r.distance[i], r.mileage[i], a.latitude / units::deg, a.longitude / units::deg, a.height,
              b.latitude / units::deg, b.longitude / units::deg, b.height, r.gauge[i] / units::mm,
              r.cross_level[i] / units::mm, r.level[i] / units::mm, r.alignment[i] / units::mm);
  }
  return out.close();
}
}  // namespace

Expected<std::vector<std::string>> write_truth(const std::filesystem::path& folder, const Truth& t, bool csv) {
  std::vector<std::string> names{"truth.h5"};
  if (auto done = write_hdf5(folder / names.back(), t); !done) return tl::unexpected(std::move(done.error()));
  if (!csv) return names;
  names.emplace_back("truth_trajectory.csv");
  if (auto done = write_trajectory(folder / names.back(), t); !done) return tl::unexpected(std::move(done.error()));
  if (!t.rails.distance.empty()) {
    names.emplace_back("truth_rails.csv");
    if (auto done = write_rails(folder / names.back(), t.rails); !done) return tl::unexpected(std::move(done.error()));
  }
  names.emplace_back("truth_sleepers.csv");
  TextOutput sleepers(folder / names.back());
  sleepers.text("distance_m");
  sleepers.end_line();
  for (const double s : t.sleepers) sleepers.print("{:.4f}\n", s);
  if (auto done = sleepers.close(); !done) return tl::unexpected(std::move(done.error()));
  names.emplace_back("truth_constants.csv");
  TextOutput constants(folder / names.back());
  constants.text("name,value_si");
  constants.end_line();
  for (const auto& [name, value] : t.constants) constants.print("{},{:.9g}\n", name, value);
  if (auto done = constants.close(); !done) return tl::unexpected(std::move(done.error()));
  return names;
}

}  // namespace versine::io
