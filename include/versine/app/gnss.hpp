// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/core/progress.hpp"
#include "versine/gnss/agreement.hpp"
#include "versine/gnss/options.hpp"

namespace versine::app {

/// Carrier-phase processing as a job names it: `[gnss] rover = ..., base = ...` of a survey, or the whole job of
/// `versine gnss`.
struct GnssProcessing {
  std::vector<InputPath> rover;       ///< RINEX 2 or 3, Hatanaka, u-blox or NovAtel raw; plain, gzip or zstd
  std::vector<InputPath> base;        ///< the same; empty: single point positioning only
  std::vector<InputPath> navigation;  ///< RINEX navigation files; raw files bring their own
  gnss::Options options;
  gnss::Direction direction = gnss::Direction::combined;
  std::optional<Eigen::Vector3d> base_geodetic;  ///< latitude, longitude (rad) and height (m), WGS84 or ETRS89
  std::optional<Eigen::Vector3d> base_ecef;      ///< m
  InputPath antenna_file;
  gnss::AgreementOptions agreement;
};
void describe(ConfigVisitor& v, GnssProcessing& g);

struct GnssResult {
  Series<sensors::GnssSample> series;  ///< GPS time; doubtful fixes marked (gnss::compare_directions)
  std::size_t epochs = 0;              ///< of the rover's observations
  std::size_t fixed = 0, confirmed = 0, doubted = 0;
  RunRecord record;
  std::string configuration;  ///< what RTKLIB was told
};

/// Runs Debian's RTKLIB programs (rnx2rtkp, convbin) as child processes in a temporary folder: forward, backward and
/// combined side by side. As processes and not as a library, because RTKLIB keeps global state, ends the program on
/// some faults, and Debian's librtklib-dev brings no header to call it by; a process cannot disturb the job, can be
/// cancelled, and is the very program that others compare with.
///
/// Fails before any processing when rover and base do not overlap, when no ephemeris covers the observations, when the
/// given base position is more than 1 km from the base's own code solution, or when RTKLIB is not installed.
[[nodiscard]] Expected<GnssResult> process_gnss(const GnssProcessing& processing, Progress& progress, Log& log);

}  // namespace versine::app
