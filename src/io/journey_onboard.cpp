// SPDX-License-Identifier: Apache-2.0
#include "versine/io/journey_onboard.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <cmath>

#include "hdf5_handle.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {

std::optional<std::vector<double>> column(hid_t group, const char* name) {
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) return std::nullopt;
  const Hdf5Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (set < 0) return std::nullopt;
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  const auto n = H5Sget_simple_extent_npoints(space);
  if (n < 0) return std::nullopt;
  std::vector<double> out(static_cast<std::size_t>(n));
  if (n > 0 && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0) return std::nullopt;
  return out;
}

struct Missing {
  std::string field, found;
};

std::vector<double> needed(hid_t group, const std::string& prefix, const char* name, std::size_t size) {
  auto c = column(group, name);
  if (!c) throw Missing{prefix + name, "no such dataset"};
  if (size != 0 && c->size() != size)
    throw Missing{prefix + name, fmt::format("{} values where times has {}", c->size(), size)};
  return std::move(*c);
}

std::optional<std::vector<double>> optional_column(hid_t group, const char* name, std::size_t size) {
  auto c = column(group, name);
  return c && c->size() == size ? c : std::nullopt;
}

georef::Recording read_group(hid_t file, const std::string& name) {
  georef::Recording out;
  const std::string gnss_name = name + "/GNSS", imu_name = name + "/IMU";
  if (H5Lexists(file, gnss_name.c_str(), H5P_DEFAULT) <= 0) throw Missing{gnss_name, "no such group"};
  const Hdf5Handle gnss(H5Gopen2(file, gnss_name.c_str(), H5P_DEFAULT), H5Gclose);
  const auto times = needed(gnss, gnss_name + "/", "times", 0);
  const std::size_t n = times.size();
  const auto lon = needed(gnss, gnss_name + "/", "lon", n), lat = needed(gnss, gnss_name + "/", "lat", n);
  const auto speed = optional_column(gnss, "speed", n), speedacc = optional_column(gnss, "speedacc", n);
  const auto accuracy = optional_column(gnss, "accuracy_horizontal", n), nsat = optional_column(gnss, "nsat", n);
  for (std::size_t i = 0; i < n; ++i) {
    georef::Fix f;
    f.time = Time::from_seconds(times[i]);
    f.position = {lat[i] * units::deg, lon[i] * units::deg, 0.0};
    if (speed && std::isfinite((*speed)[i])) f.speed = std::abs((*speed)[i]);
    if (speedacc && (*speedacc)[i] > 0.0) f.sigma_speed = (*speedacc)[i];
    if (accuracy && (*accuracy)[i] > 0.0) f.sigma = (*accuracy)[i];
    if (nsat) f.satellites = static_cast<int>((*nsat)[i]);
    out.gnss.samples.push_back(f);
  }
  if (H5Lexists(file, imu_name.c_str(), H5P_DEFAULT) <= 0) return out;
  const Hdf5Handle imu(H5Gopen2(file, imu_name.c_str(), H5P_DEFAULT), H5Gclose);
  const auto t = needed(imu, imu_name + "/", "times", 0);
  const auto x = needed(imu, imu_name + "/", "acc_x", t.size()), y = needed(imu, imu_name + "/", "acc_y", t.size());
  const auto z = needed(imu, imu_name + "/", "acc_z", t.size());
  const auto p = optional_column(imu, "gyr_x", t.size()), q = optional_column(imu, "gyr_y", t.size());
  const auto r = optional_column(imu, "gyr_z", t.size());
  out.has_turn_rate = p && q && r;
  out.imu.samples.reserve(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    georef::InertialSample s{Time::from_seconds(t[i]), {x[i], y[i], z[i]}, Eigen::Vector3d::Zero()};
    if (out.has_turn_rate) s.turn_rate = {(*p)[i], (*q)[i], (*r)[i]};
    out.imu.samples.push_back(s);
  }
  return out;
}

}  // namespace

Expected<OnboardFile> read_onboard(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file < 0) {
    return fail({.file = path.string(),
                 .found = "a file that HDF5 cannot read",
                 .expected = "HDF5 in the OnboardEU layout",
                 .advice = "check the path, or whether the file was copied whole"});
  }
  std::vector<std::string> names;
  H5Literate(
      file, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
      },
      &names);
  OnboardFile out;
  for (const auto& name : names) {
    if (!name.starts_with("journey")) continue;
    try {
      out.recordings.push_back(read_group(file, name));
      out.recordings.back().name = path.string() + ":" + name;
    } catch (const Missing& m) {
      out.faults.push_back({.file = path.string(),
                            .field = m.field,
                            .found = m.found,
                            .expected = "the OnboardEU layout",
                            .advice = "see docs/georeferencing.md for the groups and datasets"});
    }
  }
  if (out.recordings.empty()) {
    if (!out.faults.empty()) return tl::unexpected(out.faults.front());
    return fail({.file = path.string(),
                 .found = "no group 'journey_...'",
                 .expected = "the OnboardEU layout",
                 .advice = "see docs/georeferencing.md for the groups and datasets"});
  }
  return out;
}

}  // namespace versine::io
