// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate_job.hpp"

#include <fmt/format.h>

#include "versine/app/simulate_config.hpp"
#include "versine/simulation/motion.hpp"

namespace versine::app {

namespace {
void describe_defaults(ConfigVisitor& v) {
  SimulateConfig config;
  describe(v, config);
}

Expected<std::vector<std::string>> check(const std::filesystem::path& job, std::span<const std::string> overrides) {
  const auto config = read_simulate_config(job, overrides);
  if (!config) return tl::unexpected(config.error());
  if (config->journey.present) {
    const auto map = load_network(config->journey);
    if (!map) return tl::unexpected(map.error());
    return std::vector{
        fmt::format("network of {} tracks, {} stops", map->network.tracks.size(), config->journey.stops.size())};
  }
  const auto& track = config->scenario.track;
  const auto motion =
      simulation::SpeedProfile::create(config->scenario.motion, 0.0, track.alignment.length(), track.seed);
  if (!motion) return tl::unexpected(motion.error());
  return std::vector{fmt::format("line of {:.1f} m, {} elements", track.alignment.length(),
                                 track.alignment.horizontal.elements().size()),
                     fmt::format("recording of {:.1f} s with {} standstills, {} run(s)", motion->duration(),
                                 motion->stops().size(), config->runs)};
}
}  // namespace

const JobKind simulate_job{"simulate", "A scenario becomes a recording in Versine's input formats, with its truth.",
                           describe_defaults, check};

}  // namespace versine::app
