// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "target_model.hpp"
#include "versine/core/error.hpp"
#include "versine/stationing/free_station.hpp"

/// Which control point each target is.
namespace versine::stationing {

/// Targets with their control points, and a pose that most of them agree on.
struct Matching {
  std::vector<Candidate> used, left_out;  ///< agreeing, and not
  Pose pose;
  std::vector<Exclusion> excluded;  ///< unknown points, wrong numbers, angles only
  std::vector<std::string> warnings;
};

/// By number, then by consensus; targets without number, with an unknown one or with one that contradicts the rest are
/// looked up where they point. Fails when no three targets agree, with the fault that would explain it.
Expected<Matching> match_points(const ReducedStation& station, const ControlNetwork& network,
                                const FreeStationOptions& options);

/// An error of this station as a whole.
Error station_error(const ReducedStation& station, std::string found, std::string expected, std::string advice);

}  // namespace versine::stationing
