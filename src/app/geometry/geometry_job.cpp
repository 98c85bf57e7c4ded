// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry_job.hpp"

#include <fmt/format.h>

#include "versine/app/geometry.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {
namespace {

template <class Config>
void describe_defaults(ConfigVisitor& v) {
  Config config;
  describe(v, config);
}

Expected<std::vector<std::string>> check_geometry(const std::filesystem::path& job,
                                                  std::span<const std::string> overrides) {
  GeometryJobConfig config;
  if (auto done = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  const auto trajectory = io::read_trajectory(config.trajectory.description);
  if (!trajectory) return tl::unexpected(trajectory.error());
  const auto files = read_geometry_files(config.geometry);
  if (!files) return tl::unexpected(files.error());
  std::vector<std::string> out = {fmt::format("trajectory: {} points", trajectory->series.size()),
                                  fmt::format("gauge: {} readings", files->gauge.size()),
                                  fmt::format("sleeper: {} readings", files->range.size())};
  if (files->design) out.push_back(fmt::format("design: '{}', {:.1f} m", files->design->name, files->design->length()));
  if (!config.geometry.limits.empty()) {
    const auto limits = read_limits(config.geometry.limits.path);
    if (!limits) return tl::unexpected(limits.error());
    out.push_back("limits: " + limits->name);
  }
  return out;
}

Expected<std::vector<std::string>> check_calibrate(const std::filesystem::path& job,
                                                   std::span<const std::string> overrides) {
  CalibrateConfig config;
  if (auto done = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  if (auto good = check_passes(config); !good) return tl::unexpected(good.error());
  std::vector<std::string> out;
  for (const auto& pass : config.passes) {
    const auto trajectory = io::read_trajectory(pass.trajectory.description);
    if (!trajectory) return tl::unexpected(trajectory.error());
    out.push_back(fmt::format("{}: {} points", pass.name, trajectory->series.size()));
  }
  return out;
}

}  // namespace

const JobKind geometry_job{"geometry", "A trajectory, of Versine or of other software, becomes track geometry.",
                           describe_defaults<GeometryJobConfig>, check_geometry};
const JobKind calibrate_job{"calibrate",
                            "Passes over one stretch, in both orientations, give mounting angles and repeatability.",
                            describe_defaults<CalibrateConfig>, check_calibrate};

}  // namespace versine::app
