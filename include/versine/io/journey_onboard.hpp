// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/georef/recording.hpp"

namespace versine::io {

/// Reads an HDF5 file in the OnboardEU layout: groups `journey_NN` with groups `GNSS` (datasets times [s], lon, lat
/// [deg], and where there speed [m/s], speedacc, accuracy_horizontal [m], nsat) and, where there, `IMU` (times, acc_x,
/// acc_y, acc_z [m/s^2], and gyr_x, gyr_y, gyr_z [rad/s]). One recording a group. A group without GNSS, or with columns
/// of unequal length, is left out and named in `faults`; the rest is read. Fails when nothing is left.
struct OnboardFile {
  std::vector<georef::Recording> recordings;
  std::vector<Error> faults;
};
[[nodiscard]] Expected<OnboardFile> read_onboard(const std::filesystem::path& path);

}  // namespace versine::io
