// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "versine/app/georef.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

Expected<void> write_georef_csv(const std::filesystem::path& folder, const georef::Map& map,
                                const std::vector<GeorefOutcome>& outcomes, double interval) {
  fmt::memory_buffer positions, paths, switches, residuals;
  const auto to = [](fmt::memory_buffer& b) { return std::back_inserter(b); };
  fmt::format_to(to(positions),
                 "recording,journey,time_s,latitude_deg,longitude_deg,track,track_distance_m,mileage_m,path_distance_m,"
                 "speed_mps,sigma_m,probability\n");
  fmt::format_to(
      to(paths),
      "recording,journey,path,probability,log_likelihood,log_prior,position_in_path,track,reversed,from_m,to_m\n");
  fmt::format_to(to(switches), "recording,journey,time_s,from,to,probability\n");
  fmt::format_to(to(residuals), "recording,journey,fix,along_m,across_m,sigma_along_m,sigma_across_m,nis,weight\n");
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    if (!outcomes[r].result) continue;
    const auto& journeys = outcomes[r].result->journeys;
    for (std::size_t k = 0; k < journeys.size(); ++k) {
      const auto& j = journeys[k];
      const auto& best = j.paths.front();
      const auto every = static_cast<std::size_t>(std::max(1.0, std::round(interval / j.grid)));
      for (std::size_t i = 0; i < j.steps; i += every) {
        const double d = best.motion.distance[i];
        const auto place = best.coordinates.place(d);
        const auto& track = map.network.tracks[place.track.track];
        const auto g = map.network.to_geodetic(best.coordinates.position(d));
        std::string mileage;
        if (track.mileage_begin && track.mileage_end) {
          mileage = fmt::format("{:.3f}", *track.mileage_begin + (*track.mileage_end - *track.mileage_begin) *
                                                                     place.distance / track.line.length());
        }
        const Time t = j.start + Duration::from_seconds(j.grid * static_cast<double>(i));
        fmt::format_to(to(positions), "{},{},{:.3f},{:.9f},{:.9f},{},{:.3f},{},{:.3f},{:.3f},{:.3f},{:.4f}\n", r + 1,
                       k + 1, t.seconds(), g.latitude / units::deg, g.longitude / units::deg, track.line_id,
                       track.line_offset + place.distance, mileage, d, best.motion.speed[i],
                       best.motion.sigma_distance[i], best.probability);
      }
      for (std::size_t p = 0; p < j.paths.size(); ++p) {
        const auto& s = j.paths[p];
        for (std::size_t q = 0; q < s.coordinates.path().size(); ++q) {
          const auto t = s.coordinates.path()[q];
          fmt::format_to(to(paths), "{},{},{},{:.6f},{:.3f},{:.3f},{},{},{},{:.3f},{:.3f}\n", r + 1, k + 1, p + 1,
                         s.probability, s.evidence.likelihood(), s.evidence.route, q + 1, map.network.tracks[t.track].id,
                         t.reversed ? 1 : 0, s.coordinates.starts()[q], s.coordinates.starts()[q + 1]);
        }
      }
      for (const auto& s : j.switches) {
        fmt::format_to(to(switches), "{},{},{:.3f},{},{},{:.6f}\n", r + 1, k + 1, s.time.seconds(),
                       map.network.tracks[s.from.track].id, map.network.tracks[s.to.track].id, s.probability);
      }
      for (const auto& f : best.residuals) {
        fmt::format_to(to(residuals), "{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", r + 1, k + 1, f.fix + 1,
                       f.along, f.across, f.sigma_along, f.sigma_across, f.nis, f.weight);
      }
    }
  }
  const auto write = [&](const char* name, const fmt::memory_buffer& b) -> Expected<void> {
    std::ofstream stream(folder / name, std::ios::binary);
    if (!stream.write(b.data(), static_cast<std::streamsize>(b.size())).flush()) {
      return fail({.file = (folder / name).string(),
                   .found = "a file that cannot be written",
                   .expected = "space on the disk",
                   .advice = "free some space"});
    }
    return {};
  };
  auto done = write("positions.csv", positions);
  if (done) done = write("paths.csv", paths);
  if (done) done = write("switches.csv", switches);
  if (done) done = write("residuals.csv", residuals);
  return done;
}

}  // namespace versine::app
