// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <hdf5.h>

#include "hdf5_handle.hpp"
#include "versine/io/georef_result.hpp"

namespace versine::io {

namespace {

Hdf5Handle make_group(hid_t at, const std::string& name) {
  return {H5Gcreate2(at, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
}

void dataset(hid_t group, const char* name, hid_t type, const void* data, std::size_t n) {
  const hsize_t size = n;
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle options = untimed_dataset();
  const Hdf5Handle set(H5Dcreate2(group, name, type, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
  if (n > 0) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
}

void attribute(hid_t at, const char* name, double x) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle a(H5Acreate2(at, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(a, H5T_NATIVE_DOUBLE, &x);
}

void attribute(hid_t at, const char* name, std::int64_t x) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle a(H5Acreate2(at, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(a, H5T_NATIVE_INT64, &x);
}

void attribute(hid_t at, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle a(H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(a, type, text.c_str());
}

void write_path(hid_t at, const georef::Map& map, const georef::PathSolution& p) {
  attribute(at, "probability", p.probability);
  attribute(at, "log_likelihood", p.evidence.likelihood());
  attribute(at, "log_prior", p.evidence.route);
  std::string tracks;
  for (const auto& t : p.coordinates.path()) {
    tracks += fmt::format("{}{}{}", tracks.empty() ? "" : ";", t.reversed ? "-" : "+", map.network.tracks[t.track].id);
  }
  const auto column = [&](const char* name, const auto& v, hid_t type) { dataset(at, name, type, v.data(), v.size()); };
  // An attribute holds at most 64 KiB; a path of thousands of tracks goes into a dataset.
  dataset(at, "tracks", H5T_NATIVE_CHAR, tracks.data(), tracks.size());
  column("track_starts_m", p.coordinates.starts(), H5T_NATIVE_DOUBLE);
  column("distance_m", p.motion.distance, H5T_NATIVE_DOUBLE);
  column("speed_mps", p.motion.speed, H5T_NATIVE_FLOAT);
  column("sigma_distance_m", p.motion.sigma_distance, H5T_NATIVE_FLOAT);
  column("sigma_speed_mps", p.motion.sigma_speed, H5T_NATIVE_FLOAT);
  std::vector<float> residual;
  residual.reserve(7 * p.residuals.size());
  std::vector<std::int64_t> fix;
  for (const auto& r : p.residuals) {
    fix.push_back(static_cast<std::int64_t>(r.fix));
    for (const float x : {r.along, r.across, r.sigma_along, r.sigma_across, r.nis, r.weight}) residual.push_back(x);
  }
  column("residual_fix", fix, H5T_NATIVE_INT64);
  const hsize_t size[2] = {fix.size(), 6};
  const Hdf5Handle space(H5Screate_simple(2, size, nullptr), H5Sclose);
  const Hdf5Handle options = untimed_dataset();
  const Hdf5Handle set(H5Dcreate2(at, "residuals", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, options, H5P_DEFAULT),
                       H5Dclose);
  if (!fix.empty()) H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, residual.data());
  attribute(set, "columns", "along_m across_m sigma_along_m sigma_across_m nis weight");
}

}  // namespace

Expected<void> write_georef_hdf5(const std::filesystem::path& path, const georef::Map& map,
                                 const GeorefResults& results) {
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (file < 0) {
    return fail({.file = path.string(),
                 .found = "a file that cannot be written",
                 .expected = "a writable folder",
                 .advice = "free some space"});
  }
  attribute(file, "network", map.network.file);
  attribute(file, "crs", map.network.projection.definition());
  for (std::size_t r = 0; r < results.size(); ++r) {
    if (results[r] == nullptr) continue;
    const Hdf5Handle recording = make_group(file, fmt::format("recording_{}", r + 1));
    attribute(recording, "name", results[r]->name);
    for (std::size_t k = 0; k < results[r]->journeys.size(); ++k) {
      const auto& j = results[r]->journeys[k];
      const Hdf5Handle journey = make_group(recording, fmt::format("journey_{}", k + 1));
      attribute(journey, "start_ns", j.start.ns);
      attribute(journey, "grid_s", j.grid);
      attribute(journey, "entropy_nat", j.entropy);
      for (std::size_t p = 0; p < j.paths.size(); ++p) {
        const Hdf5Handle group = make_group(journey, fmt::format("path_{}", p + 1));
        write_path(group, map, j.paths[p]);
      }
    }
  }
  if (H5Fflush(file, H5F_SCOPE_LOCAL) < 0) {
    return fail({.file = path.string(),
                 .found = "a file that cannot be written whole",
                 .expected = "space on the disk",
                 .advice = "free some space"});
  }
  return {};
}

}  // namespace versine::io
