// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "versine/app/georef.hpp"
#include "versine/io/journey_brussels.hpp"
#include "versine/io/journey_onboard.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {

namespace {

bool begins_with(const std::filesystem::path& path, std::string_view bytes) {
  std::ifstream stream(path, std::ios::binary);
  std::string head(bytes.size(), '\0');
  return stream.read(head.data(), static_cast<std::streamsize>(head.size())) && head == bytes;
}

bool is_brussels(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string header;
  std::getline(stream, header);
  return header.find("position_type") != std::string::npos && header.find("timestamp") != std::string::npos;
}

Expected<georef::Recording> of_gnss(const io::GnssFile& file, std::string name) {
  auto gnss = io::read_gnss(file);
  if (!gnss) return tl::unexpected(gnss.error());
  georef::Recording r;
  r.name = std::move(name);
  r.gnss = georef::to_fixes(gnss->series);
  r.record = std::move(gnss->record);
  return r;
}

/// Rates from increments. The series' own axes do not matter: the forward axis is found.
void add_imu(const sensors::ImuSeries& imu, georef::Recording& out) {
  const double rate = 1.0 / imu.interval.seconds();
  out.has_turn_rate = true;
  out.imu.scale = imu.scale;
  out.imu.samples.reserve(imu.size());
  for (const auto& s : imu) out.imu.samples.push_back({s.time, rate * s.dvel, rate * s.dtheta});
}

/// Speeds from distances at least half a second apart.
void add_odometer(const Series<sensors::OdometerSample>& odometer, georef::Recording& out) {
  for (std::size_t i = 0, j = 1; j < odometer.size(); ++j) {
    const double dt = (odometer[j].time - odometer[i].time).seconds();
    if (dt < 0.5) continue;
    const Time middle = odometer[i].time + Duration::from_seconds(0.5 * dt);
    out.speed.samples.push_back({middle, (odometer[j].distance - odometer[i].distance) / dt});
    i = j;
  }
}

}  // namespace

Expected<std::unique_ptr<georef::Map>> load_map(const GeorefConfig& c) {
  const auto source = io::read_network({c.network.path, c.layer, c.id_field, c.source_crs, c.osm_types});
  if (!source) return tl::unexpected(source.error());
  auto network = network::build(*source, {.crs = c.crs, .snap = c.snap, .largest_turn = c.largest_turn});
  if (!network) return tl::unexpected(network.error());
  return std::make_unique<georef::Map>(std::move(*network));
}

Expected<std::vector<georef::Recording>> load_recordings(const std::filesystem::path& path,
                                                         std::vector<Error>& faults) {
  if (begins_with(path, "\x89HDF\r\n\x1a\n")) {
    auto file = io::read_onboard(path);
    if (!file) return tl::unexpected(file.error());
    faults.insert(faults.end(), file->faults.begin(), file->faults.end());
    return std::move(file->recordings);
  }
  io::GnssFile file;
  file.table.path = path;
  auto one = is_brussels(path) ? io::read_brussels_log(path) : of_gnss(file, path.string());
  if (!one) return tl::unexpected(one.error());
  std::vector<georef::Recording> out;
  out.push_back(std::move(*one));
  return out;
}

Expected<georef::Recording> load_recording(const RecordingConfig& c) {
  if (!c.gnss.given()) {
    return fail({.field = "recording.gnss.file",
                 .found = "nothing",
                 .expected = "a file of GNSS positions",
                 .advice = "name it in [recording.gnss]"});
  }
  auto out = of_gnss(c.gnss.description, c.name.empty() ? c.gnss.file.written : c.name);
  if (!out) return out;
  if (c.imu.given()) {
    const auto imu = io::read_imu(c.imu.description);
    if (!imu) return tl::unexpected(imu.error());
    out->record.append(imu->record);
    add_imu(imu->series, *out);
  }
  if (c.odometer.given()) {
    const auto odometer = io::read_odometer(c.odometer.description);
    if (!odometer) return tl::unexpected(odometer.error());
    out->record.append(odometer->record);
    add_odometer(odometer->series, *out);
  }
  if (c.speed.given()) {
    const auto speed = io::read_speed(c.speed.description);
    if (!speed) return tl::unexpected(speed.error());
    out->record.append(speed->record);
    out->speed = speed->series;
  }
  return out;
}

}  // namespace versine::app
