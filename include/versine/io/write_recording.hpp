// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/simulation/irregularity.hpp"
#include "versine/simulation/recording.hpp"

/// A simulated recording in Versine's own input formats, and its truth (docs/simulation.md).
namespace versine::io {

/// Writes imu.csv, odometer_1.csv, ..., gauge.csv, sleeper.csv, gnss.csv, landmarks.csv, control.csv, readings.csv and
/// axle_box.h5 into an existing folder, those that the recording has. Returns their names.
struct RecordingOutput {
  bool imu_rates = false;  ///< mean rates instead of increments
};
[[nodiscard]] Expected<std::vector<std::string>> write_recording(const std::filesystem::path& folder,
                                                                 const simulation::SimulatedRecording& recording,
                                                                 const RecordingOutput& output = {});

/// Writes truth.h5, and with `csv` truth_trajectory.csv, truth_rails.csv, truth_sleepers.csv, truth_constants.csv.
[[nodiscard]] Expected<std::vector<std::string>> write_truth(const std::filesystem::path& folder,
                                                             const simulation::Truth& truth, bool csv);

/// Deviations from a CSV: distance_m at a fixed step, and any of level_mm, alignment_mm, cross_level_mm, gauge_mm.
[[nodiscard]] Expected<simulation::Deviations> read_deviations(const std::filesystem::path& path);

}  // namespace versine::io
