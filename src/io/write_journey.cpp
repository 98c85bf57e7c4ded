// SPDX-License-Identifier: Apache-2.0
#include "versine/io/write_journey.hpp"

#include "hdf5_file.hpp"
#include "text_output.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {
template <class Samples, class Value>
std::vector<double> column(const Samples& samples, const Value& value) {
  std::vector<double> out;
  out.reserve(samples.size());
  for (const auto& s : samples) out.push_back(value(s));
  return out;
}
}  // namespace

Expected<void> write_onboard(const std::filesystem::path& path, const simulation::SimulatedRecording& r) {
  auto file = Hdf5File::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  const auto put = [&](const std::string& name, const char* unit, const auto& samples, const auto& value) {
    file->write("journey_01/" + name, column(samples, value), unit);
  };
  file->group("journey_01");
  file->group("journey_01/GNSS");
  put("GNSS/times", "s", r.gnss, [](const auto& s) { return s.time.seconds(); });
  put("GNSS/lon", "deg", r.gnss, [](const auto& s) { return s.position.longitude / units::deg; });
  put("GNSS/lat", "deg", r.gnss, [](const auto& s) { return s.position.latitude / units::deg; });
  put("GNSS/accuracy_horizontal", "m", r.gnss, [](const auto& s) { return s.sigma_ned.template head<2>().norm(); });
  if (!r.gnss.empty() && r.gnss.front().v_ned) {
    put("GNSS/speed", "m/s", r.gnss, [](const auto& s) { return s.v_ned->template head<2>().norm(); });
    put("GNSS/speedacc", "m/s", r.gnss, [](const auto& s) { return s.sigma_v_ned.x(); });
  }
  if (!r.imu.empty()) {
    file->group("journey_01/IMU");
    const double rate = 1.0 / r.imu.interval.seconds();
    put("IMU/times", "s", r.imu, [](const auto& s) { return s.time.seconds(); });
    const char* axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
      put(std::string("IMU/acc_") + axes[i], "m/s^2", r.imu, [&](const auto& s) { return rate * s.dvel(i); });
      put(std::string("IMU/gyr_") + axes[i], "rad/s", r.imu, [&](const auto& s) { return rate * s.dtheta(i); });
    }
  }
  return file->close();
}

Expected<void> write_network_geojson(const std::filesystem::path& path, const network::NetworkSource& source) {
  TextOutput out(path);
  out.text("{\"type\": \"FeatureCollection\",\n");
  if (!source.crs.empty()) {
    out.print("\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": \"{}\"}}}},\n", source.crs);
  }
  out.text("\"features\": [\n");
  // Without a map the points are angles.
  const double scale = source.crs.empty() ? 1.0 / units::deg : 1.0;
  for (std::size_t i = 0; i < source.tracks.size(); ++i) {
    const auto& track = source.tracks[i];
    out.print(
        "{{\"type\": \"Feature\", \"properties\": {{\"id\": \"{}\"}}, \"geometry\": {{\"type\": \"LineString\", "
        "\"coordinates\": [",
        track.id);
    for (std::size_t k = 0; k < track.points.size(); ++k) {
      out.print("{}[{:.10g}, {:.10g}]", k == 0 ? "" : ", ", scale * track.points[k].x(), scale * track.points[k].y());
    }
    out.print("]}}}}{}\n", i + 1 < source.tracks.size() ? "," : "");
  }
  out.text("]}\n");
  return out.close();
}

}  // namespace versine::io
