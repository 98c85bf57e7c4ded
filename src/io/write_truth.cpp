// SPDX-License-Identifier: Apache-2.0
#include "csv_writer.hpp"
#include "hdf5_columns.hpp"
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

Expected<void> write_hdf5(const std::filesystem::path& path, const Truth& t) {
  Hdf5Columns file(path, t.trajectory.scale);
  std::vector<std::int64_t> times;
  for (const auto& p : t.trajectory) times.push_back(p.time.ns);
  file.times("trajectory", times);
  const auto column = [&](const char* name, const char* unit, const auto& value) {
    file.column("trajectory", name, unit, gather(t.trajectory, value));
  };
  column("latitude_deg", "deg", [](const auto& p) { return p.position.latitude / units::deg; });
  column("longitude_deg", "deg", [](const auto& p) { return p.position.longitude / units::deg; });
  column("height_m", "m", [](const auto& p) { return p.position.height; });
  column("velocity_north_mps", "m/s", [](const auto& p) { return p.v_eb_n.x(); });
  column("velocity_east_mps", "m/s", [](const auto& p) { return p.v_eb_n.y(); });
  column("velocity_down_mps", "m/s", [](const auto& p) { return p.v_eb_n.z(); });
  column("roll_deg", "deg", [](const auto& p) { return geodesy::to_euler(p.q_nb).roll / units::deg; });
  column("pitch_deg", "deg", [](const auto& p) { return geodesy::to_euler(p.q_nb).pitch / units::deg; });
  column("heading_deg", "deg", [](const auto& p) { return geodesy::to_euler(p.q_nb).yaw / units::deg; });
  file.column("trajectory", "distance_m", "m", gather(t.progress, [](const auto& p) { return p.distance; }));
  file.column("trajectory", "mileage_m", "m", gather(t.progress, [](const auto& p) { return p.mileage; }));
  file.column("trajectory", "speed_mps", "m/s", gather(t.progress, [](const auto& p) { return p.speed; }));
  const auto& r = t.rails;
  if (!r.distance.empty()) {
    file.column("rails", "distance_m", "m", r.distance);
    file.column("rails", "mileage_m", "m", r.mileage);
    for (const auto& [side, rail] : {std::pair{"left", &r.left}, std::pair{"right", &r.right}}) {
      const std::string name = side;
      file.column("rails", name + "_latitude_deg", "deg",
                  gather(*rail, [](const auto& g) { return g.latitude / units::deg; }));
      file.column("rails", name + "_longitude_deg", "deg",
                  gather(*rail, [](const auto& g) { return g.longitude / units::deg; }));
      file.column("rails", name + "_height_m", "m", gather(*rail, [](const auto& g) { return g.height; }));
    }
    file.column("rails", "gauge_m", "m", r.gauge);
    file.column("rails", "cross_level_m", "m", r.cross_level);
    file.column("rails", "level_m", "m", r.level);
    file.column("rails", "alignment_m", "m", r.alignment);
  }
  file.column("sleepers", "distance_m", "m", t.sleepers);
  std::vector<std::int64_t> bias_times;
  for (const auto& s : t.bias) bias_times.push_back(s.time.ns);
  if (!bias_times.empty()) {
    file.times("imu_bias", bias_times);
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      file.column("imu_bias", "gyro_" + axis + "_radps", "rad/s",
                  gather(t.bias, [&](const auto& s) { return s.dtheta(i); }));
      file.column("imu_bias", "accel_" + axis + "_mps2", "m/s^2",
                  gather(t.bias, [&](const auto& s) { return s.dvel(i); }));
    }
  }
  for (const auto& [name, value] : t.constants) file.attribute(name, value);
  return file.close();
}

Expected<void> write_trajectory(const std::filesystem::path& path, const Truth& t) {
  CsvWriter out(path,
                "time_s,latitude_deg,longitude_deg,height_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,"
                "roll_deg,pitch_deg,heading_deg,distance_m,mileage_m,speed_mps,track,track_distance_m");
  for (std::size_t i = 0; i < t.trajectory.size(); ++i) {
    const auto& p = t.trajectory[i];
    const auto& at = t.progress[i];
    const geodesy::Euler e = geodesy::to_euler(p.q_nb);
    out.row("{},{:.12f},{:.12f},{:.6f},{:.7f},{:.7f},{:.7f},{:.8f},{:.8f},{:.8f},{:.6f},{:.6f},{:.7f},{},{:.6f}",
            ExactSeconds{p.time}, p.position.latitude / units::deg, p.position.longitude / units::deg,
            p.position.height, p.v_eb_n.x(), p.v_eb_n.y(), p.v_eb_n.z(), e.roll / units::deg, e.pitch / units::deg,
            e.yaw / units::deg, at.distance, at.mileage, at.speed, at.track, at.track_distance);
  }
  return out.close();
}

Expected<void> write_rails(const std::filesystem::path& path, const simulation::RailTruth& r) {
  CsvWriter out(path,
                "distance_m,mileage_m,left_latitude_deg,left_longitude_deg,left_height_m,right_latitude_deg,"
                "right_longitude_deg,right_height_m,gauge_mm,cross_level_mm,level_mm,alignment_mm");
  for (std::size_t i = 0; i < r.distance.size(); ++i) {
    const auto &a = r.left[i], &b = r.right[i];
    out.row("{:.4f},{:.4f},{:.12f},{:.12f},{:.6f},{:.12f},{:.12f},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f}", r.distance[i],
            r.mileage[i], a.latitude / units::deg, a.longitude / units::deg, a.height, b.latitude / units::deg,
            b.longitude / units::deg, b.height, r.gauge[i] / units::mm, r.cross_level[i] / units::mm,
            r.level[i] / units::mm, r.alignment[i] / units::mm);
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
  CsvWriter sleepers(folder / names.back(), "distance_m");
  for (const double s : t.sleepers) sleepers.row("{:.4f}", s);
  if (auto done = sleepers.close(); !done) return tl::unexpected(std::move(done.error()));
  names.emplace_back("truth_constants.csv");
  CsvWriter constants(folder / names.back(), "name,value_si");
  for (const auto& [name, value] : t.constants) constants.row("{},{:.9g}", name, value);
  if (auto done = constants.close(); !done) return tl::unexpected(std::move(done.error()));
  return names;
}

}  // namespace versine::io
