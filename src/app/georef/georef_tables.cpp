// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "versine/app/georef.hpp"
#include "versine/core/units.hpp"
#include "versine/georef/journeys.hpp"

namespace versine::app {

namespace {

using georef::JourneyResult;

/// A CSV file in memory.
class Table {
 public:
  Table(const char* name, const char* header) : name_(name) { print("{}\n", header); }
  template <class... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<T>(values)...);
  }
  [[nodiscard]] Expected<void> write(const std::filesystem::path& folder) const {
    std::ofstream stream(folder / name_, std::ios::binary);
    if (stream.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size())).flush()) return {};
    return fail({.file = (folder / name_).string(),
                 .found = "a file that cannot be written",
                 .expected = "space on the disk",
                 .advice = "free some space"});
  }

 private:
  const char* name_;
  fmt::memory_buffer buffer_;
};

struct Tables {
  Table positions{"positions.csv",
                  "recording,journey,time_s,latitude_deg,longitude_deg,track,track_distance_m,mileage_m,"
                  "path_distance_m,azimuth_deg,speed_mps,sigma_m,sigma_speed_mps,probability"};
  Table fixes{"fixes.csv",
              "recording,journey,fix,time_s,latitude_deg,longitude_deg,sigma_m,speed_mps,status,along_m,across_m,"
              "sigma_along_m,sigma_across_m,nis,weight,path_distance_m"};
  Table paths{
      "paths.csv",
      "recording,journey,path,probability,log_likelihood,log_prior,position_in_path,track,reversed,from_m,to_m"};
  Table switches{"switches.csv", "recording,journey,time_s,from,to,probability"};
};

void add_positions(const georef::Map& map, const JourneyResult& j, std::size_t r, std::size_t k, double interval,
                   Table& out) {
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
    const double azimuth = std::fmod(best.coordinates.azimuth(d, 10.0) / units::deg + 7200.0, 360.0);
    out.print("{},{},{:.3f},{:.9f},{:.9f},{},{:.3f},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f}\n", r, k, t.seconds(),
              g.latitude / units::deg, g.longitude / units::deg, track.line_id, track.line_offset + place.distance,
              mileage, d, azimuth, best.motion.speed[i], best.motion.sigma_distance[i], best.motion.sigma_speed[i],
              best.probability);
  }
}

void add_fixes(const georef::RecordingResult& result, const JourneyResult& j, std::size_t r, std::size_t k,
               const georef::Options& options, Table& out) {
  const auto& best = j.paths.front();
  auto residual = best.residuals.begin();
  const Time end = j.end();
  for (std::size_t i = result.fixes.lower_bound(j.start); i < result.fixes.size() && result.fixes[i].time <= end; ++i) {
    const auto& f = result.fixes[i];
    out.print("{},{},{},{:.3f},{:.9f},{:.9f},{:.3f},", r, k, i + 1, f.time.seconds(), f.position.latitude / units::deg,
              f.position.longitude / units::deg, georef::fix_sigma(f, options.gnss));
    if (f.speed) out.print("{:.3f}", *f.speed);
    while (residual != best.residuals.end() && residual->fix < i) ++residual;
    const auto step = std::min<std::size_t>(
        j.steps - 1, static_cast<std::size_t>(std::max(0.0, std::round((f.time - j.start).seconds() / j.grid))));
    if (residual == best.residuals.end() || residual->fix != i) {
      out.print(",path_only,,,,,,,{:.3f}\n", best.motion.distance[step]);
      continue;
    }
    const char* status = residual->weight > 0.5F ? "used" : residual->weight > 0.0F ? "weak" : "rejected";
    out.print(",{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", status, residual->along, residual->across,
              residual->sigma_along, residual->sigma_across, residual->nis, residual->weight,
              best.motion.distance[step]);
  }
}

void add_paths(const georef::Map& map, const JourneyResult& j, std::size_t r, std::size_t k, Tables& out) {
  for (std::size_t p = 0; p < j.paths.size(); ++p) {
    const auto& s = j.paths[p];
    for (std::size_t q = 0; q < s.coordinates.path().size(); ++q) {
      const auto t = s.coordinates.path()[q];
      out.paths.print("{},{},{},{:.6f},{:.3f},{:.3f},{},{},{},{:.3f},{:.3f}\n", r, k, p + 1, s.probability,
                      s.evidence.likelihood(), s.evidence.route, q + 1, map.network.tracks[t.track].id,
                      t.reversed ? 1 : 0, s.coordinates.starts()[q], s.coordinates.starts()[q + 1]);
    }
  }
  for (const auto& s : j.switches) {
    out.switches.print("{},{},{:.3f},{},{},{:.6f}\n", r, k, s.time.seconds(), map.network.tracks[s.from.track].id,
                       map.network.tracks[s.to.track].id, s.probability);
  }
}

}  // namespace

Expected<void> write_georef_tables(const std::filesystem::path& folder, const georef::Map& map,
                                   const std::vector<GeorefOutcome>& outcomes, const georef::Options& options,
                                   double interval) {
  Tables tables;
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    if (!outcomes[r].result) continue;
    const auto& journeys = outcomes[r].result->journeys;
    for (std::size_t k = 0; k < journeys.size(); ++k) {
      add_positions(map, journeys[k], r + 1, k + 1, interval, tables.positions);
      add_fixes(*outcomes[r].result, journeys[k], r + 1, k + 1, options, tables.fixes);
      add_paths(map, journeys[k], r + 1, k + 1, tables);
    }
  }
  for (const Table* table : {&tables.positions, &tables.fixes, &tables.paths, &tables.switches}) {
    if (auto done = table->write(folder); !done) return done;
  }
  return {};
}

}  // namespace versine::app
