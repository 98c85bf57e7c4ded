// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "versine/simulation/motion.hpp"
#include "versine/simulation/simulate.hpp"

namespace versine::simulation {

namespace {
tl::unexpected<Error> refuse(std::string field, std::string found, std::string expected, std::string advice) {
  return fail({.field = std::move(field),
               .found = std::move(found),
               .expected = std::move(expected),
               .advice = std::move(advice)});
}

Expected<void> check_track(const TrackModel& track) {
  if (track.alignment.horizontal.elements().empty() || !(track.alignment.length() > 0.0)) {
    return refuse("track", "no horizontal alignment", "elements, or an alignment file",
                  "add [[track.horizontal]] tables, or 'track.alignment_file'");
  }
  if (track.alignment.crs.empty()) {
    return refuse("track.crs", "nothing", "the map that the alignment's coordinates belong to",
                  "add for example crs = \"EPSG:25832\"");
  }
  for (std::size_t i = 0; i < track.alignment.cant.points().size(); ++i) {
    const double cant = track.alignment.cant.points()[i].cant;
    if (!(std::abs(cant) <= 0.180)) {
      return refuse(fmt::format("track.cant[{}].cant_mm", i), fmt::format("{:.0f} mm", cant * 1e3),
                    "at most 180 mm, the largest cant that railways build",
                    "give the cant in mm over the 1500 mm of the rail-head centres");
    }
  }
  if (!(track.grid > 0.0 && track.grid <= 1.0)) {
    return refuse("track.grid_m", fmt::format("{} m", track.grid), "more than 0, at most 1 m",
                  "0.1 for a trolley, 0.25 for a train");
  }
  if (track.spectrum != Spectrum::none && !(track.shortest >= 4.0 * track.grid)) {
    return refuse("track.shortest_m", fmt::format("{} m", track.shortest),
                  fmt::format("at least four points of the grid, {} m", 4.0 * track.grid),
                  "leave shorter waves out, or make track.grid_m smaller");
  }
  if (track.spectrum != Spectrum::none && !(track.longest > track.shortest)) {
    return refuse("track.longest_m", fmt::format("{} m", track.longest), "more than track.shortest_m",
                  "give the band from the shortest to the longest wavelength");
  }
  return {};
}

Expected<void> check_equipment(const Equipment& on, double duration) {
  for (std::size_t i = 0; i < on.odometers.size(); ++i) {
    if (on.odometers[i].output == OdometerModel::Output::pulses && !(on.odometers[i].quantum > 0.0)) {
      return refuse(fmt::format("odometer[{}].count_mm", i), "nothing", "the distance of one pulse",
                    "add for example count_mm = 2.5, or write distances (output = \"distance\")");
    }
  }
  for (std::size_t i = 0; i < on.faults.size(); ++i) {
    if (on.faults[i].at > duration) {
      return refuse(fmt::format("fault[{}].at_s", i), fmt::format("{} s", on.faults[i].at),
                    fmt::format("a time within the recording of {:.0f} s", duration), "put the fault earlier");
    }
  }
  return {};
}
}  // namespace

Expected<void> check(const Scenario& scenario) {
  if (auto good = check_track(scenario.track); !good) return good;
  const auto motion =
      SpeedProfile::create(scenario.motion, 0.0, scenario.track.alignment.length(), scenario.track.seed);
  if (!motion) return tl::unexpected(motion.error());
  if (!(motion->duration() > 0.0)) {
    return refuse("motion", "a recording of 0 s", "a stand or a leg", "add [[motion.leg]] with to_m and speed_kmh");
  }
  if (!(scenario.motion.unevenness >= 0.0 && scenario.motion.unevenness <= 0.15)) {
    return refuse("motion.unevenness", fmt::format("{}", scenario.motion.unevenness), "0 to 0.15",
                  "0.1 is a person who pushes");
  }
  return check_equipment(scenario.equipment, motion->duration());
}

}  // namespace versine::simulation
