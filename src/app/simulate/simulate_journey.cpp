// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate_journey.hpp"

#include <fmt/format.h>

#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"
#include "versine/network/build.hpp"

namespace versine::app {

void describe(ConfigVisitor& v, JourneyConfig& c) {
  v.table(
      "network", "A railway network to drive on, instead of [track].",
      [&](ConfigVisitor& t) {
        t.value("file", c.file, {.doc = "Map file, as 'versine georef' reads it.", .example = "\"network.geojson\""});
        t.value("crs", c.crs, {.doc = "Projection to work in; default: the file's own."});
        t.value("height_m", c.height, {.doc = "Ellipsoidal height of all tracks.", .unit = "m"});
        t.value("smoothing_m", c.smoothing,
                {.doc = "A map's corners are rounded over three times this.", .unit = "m", .min = 2, .max = 50});
        t.table(
            "made", "A made network: double line, scissors, station, siding, turning triangle.",
            [&](ConfigVisitor& m) {
              auto& l = c.layout;
              m.value("length_m", l.length, {.doc = "Of the double line.", .unit = "m", .min = 3000, .max = 1e6});
              m.value("spacing_m", l.spacing, {.doc = "Between parallel tracks.", .unit = "m", .min = 3, .max = 20});
              m.value("crossovers", l.crossovers, {.doc = "Scissors, 460 m apart.", .min = 0, .max = 1000});
              m.value("station_tracks", l.station_tracks, {.doc = "Beside the double line.", .min = 0, .max = 20});
              m.value("triangle", l.triangle, {.doc = "With a turning triangle."});
              m.value("crs", l.crs, {.doc = "Map of its coordinates."});
              m.value("easting_m", l.easting, {.doc = "Western end of track A.", .unit = "m"});
              m.value("northing_m", l.northing, {.doc = "Western end of track A.", .unit = "m"});
            },
            &c.made);
      },
      &c.present);
  v.tables<simulation::JourneyStop>(
      "journey", "Where the vehicle stands: the first is its start, the others in the order of driving.", c.stops,
      [](ConfigVisitor& t, simulation::JourneyStop& s) {
        t.value("track", s.track, {.doc = "Id in the map.", .required = true, .example = "\"A1\""});
        t.value("distance_m", s.distance,
                {.doc = "Of the vehicle's middle from the track's beginning.", .unit = "m", .min = 0});
        t.value("speed_kmh", s.speed, {.doc = "On the way here.", .unit = "km/h", .scale = units::kmh, .max = 400});
        t.value("acceleration_mps2", s.acceleration, {.doc = "Largest, also for braking.", .unit = "m/s^2", .max = 10});
        t.value("stand_s", s.stand, {.doc = "Standing here.", .unit = "s", .min = 0});
      });
}

Expected<JourneyNetwork> load_network(const JourneyConfig& c) {
  network::BuildOptions options;
  options.crs = c.crs;
  auto source = c.made ? Expected<network::NetworkSource>(simulation::make_network(c.layout))
                       : io::read_network({.path = c.file.path});
  if (!source) return tl::unexpected(std::move(source.error()));
  auto network = network::build(*source, options);
  if (!network) return tl::unexpected(std::move(network.error()));
  return JourneyNetwork{std::move(*network), c.made ? std::optional(std::move(*source)) : std::nullopt};
}

std::string georef_job_for(const JourneyConfig& c) {
  return fmt::format(
      "# Puts this simulated recording onto the map: versine georef georef.toml\n"
      "job = \"georef\"\nrecordings = [\"journey.h5\"]\n\n[network]\nfile = \"{}\"\n{}",
      c.made ? "network.geojson" : c.file.path.string(), c.crs.empty() ? "" : fmt::format("crs = \"{}\"\n", c.crs));
}

}  // namespace versine::app
