// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "versine/batch/journey_entry.hpp"
#include "versine/batch/manifest.hpp"

namespace versine::batch {

struct Merged {
  std::size_t units = 0, rejected = 0, open = 0, journeys = 0, passes = 0, failures = 0;
};
/// One SQLite file of all journeys of a manifest (tables: docs/batch.md), in order of the units' names, so that it is
/// byte-identical whatever ran where. Built in `scratch`, then written beside `out` and renamed. Fails (2) while units
/// are open, unless `partial`.
[[nodiscard]] Outcome<Merged> merge(const Store& store, const Manifest& manifest, const std::filesystem::path& out,
                                    bool partial, const std::filesystem::path& scratch);

/// Who passed a metre of a track.
struct PassQuery {
  std::string track;  ///< line of the map
  double at = 0.0;    ///< m from its beginning
  std::optional<Time> from, to;
  double smallest_probability = 0.0;
};
struct PassFound {
  Knot here;
  double probability = 0.0;  ///< that the vehicle was on this track
  TimeScale scale = TimeScale::recorder;
  std::string file, recording;
  int journey = 1;
  std::string unit;
};
/// In order of time. Fails (64) when the catalogue cannot be read or has no such track.
[[nodiscard]] Outcome<std::vector<PassFound>> find_passes(const std::filesystem::path& catalogue,
                                                          const PassQuery& query);

}  // namespace versine::batch
