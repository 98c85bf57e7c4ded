// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate_job.hpp"

#include <fmt/format.h>

#include "versine/app/simulate.hpp"

namespace versine::app {

namespace {
void describe_defaults(ConfigVisitor& v) {
  SimulateConfig config;
  describe(v, config);
}

Expected<std::vector<std::string>> check(const std::filesystem::path& job, std::span<const std::string> overrides) {
  const auto config = read_simulate_config(job, overrides);
  if (!config) return tl::unexpected(config.error());
  const auto prepared = prepare_world(*config);
  if (!prepared) return tl::unexpected(prepared.error());
  const auto& world = *prepared->world;
  const auto& track = config->scenario.track.alignment;
  return std::vector{
      prepared->map ? fmt::format("network of {} tracks", prepared->map->network.tracks.size())
                    : fmt::format("line of {:.1f} m, {} elements", track.length(), track.horizontal.elements().size()),
      fmt::format("recording of {:.1f} s with {} standstills, {} run(s)", world.duration, world.stops.size(),
                  config->runs)};
}

/// A survey that runs as it is.
constexpr std::string_view starter = R"(job = "simulate"
title = "400 m with a curve, a total station every 60 m"

[track]
crs = "EPSG:25832"
easting_m = 600000.0
northing_m = 5400000.0
spectrum = "china-ballastless"

[[track.horizontal]]
type = "line"
length_m = 100.0
[[track.horizontal]]
type = "clothoid"
length_m = 60.0
[[track.horizontal]]
type = "arc"
length_m = 140.0
radius_m = 800.0
turn = "right"
[[track.horizontal]]
type = "clothoid"
length_m = 60.0
[[track.horizontal]]
type = "line"
length_m = 40.0

[[motion.leg]]
to_m = 390.0
speed_kmh = 3.6
stop_s = 30.0
stop_every_m = 60.0
stop_each_s = 20.0

[imu]
grade = "navigation-rlg"

[[odometer]]

[gauge]

[total_station]
every_m = 60.0
)";
}  // namespace

const JobKind simulate_job{"simulate", "A scenario becomes a recording in Versine's input formats, with its truth.",
                           describe_defaults, check, starter};

}  // namespace versine::app
