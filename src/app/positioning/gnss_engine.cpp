// SPDX-License-Identifier: Apache-2.0
#include "gnss_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "versine/core/calendar.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {

namespace fs = std::filesystem;
using namespace gnss_files;
using gnss::Direction;

GnssEngine::GnssEngine(const GnssProcessing& g, const Files& files, const Workspace& workspace, fs::path program,
                       Progress& progress)
    : g_(g),
      files_(files),
      workspace_(workspace),
      program_(std::move(program)),
      progress_(progress),
      options_(g.options) {
  options_.antenna_file = g.antenna_file.empty() ? "" : g.antenna_file.path.string();
  if (g.base_geodetic) {
    options_.base_ecef = geodesy::wgs84.to_ecef({g.base_geodetic->x(), g.base_geodetic->y(), g.base_geodetic->z()}).r;
  }
  if (g.base_ecef) options_.base_ecef = g.base_ecef;
}

/// The base's code solution over its first ten minutes, ECEF; nothing when it has none.
Expected<std::optional<Eigen::Vector3d>> GnssEngine::base_by_code() {
  gnss::Options single = options_;
  single.positioning = gnss::Positioning::single;
  single.base_ecef.reset();
  const auto series = run(single, Direction::forward, {files_.base}, "base", 600.0, 0.0, 0.05);
  if (!series) return tl::unexpected(series.error());
  if (series->empty()) return std::optional<Eigen::Vector3d>{};
  std::vector<double> x, y, z;
  for (const auto& s : *series) {
    const auto r = geodesy::wgs84.to_ecef(s.position).r;
    x.push_back(r.x()), y.push_back(r.y()), z.push_back(r.z());
  }
  const auto middle = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  return std::optional(Eigen::Vector3d(middle(x), middle(y), middle(z)));
}

Expected<void> GnssEngine::check_base() {
  std::optional<Eigen::Vector3d> used = options_.base_ecef;
  const char* source = "given";
  if (!used && !options_.average_base) used = files_.base.front().scan.approximate, source = "in its file's header";
  if (!used && !options_.average_base) {
    return fail({.file = g_.base.front().written,
                 .field = "base position",
                 .found = "none given, and none in the header",
                 .expected = "a position of centimetres",
                 .advice = "give base_position or base_ecef_m (or average_base = true for metres)"});
  }
  const auto code = base_by_code();
  if (!code) return tl::unexpected(code.error());
  if (!used || !*code) return {};
  const double apart = (*used - **code).norm();
  if (apart < 1000.0) return {};
  return fail(
      {.file = g_.base.front().written,
       .field = "base position",
       .found = fmt::format("the position {} is {:.1f} km from the base's own code solution ({:.0f}, {:.0f}, {:.0f})",
                            source, apart / 1000.0, (*code)->x(), (*code)->y(), (*code)->z()),
       .expected = "less than 1 km",
       .advice = "give the coordinates of this base station (latitude before longitude, metres for ECEF)"});
}

Expected<Series<sensors::GnssSample>> GnssEngine::solve(Direction direction, double from, double to) {
  auto files = std::vector<std::vector<File>>{files_.rover};
  if (options_.positioning != gnss::Positioning::single) files.push_back(files_.base);
  static constexpr const char* names[] = {"forward", "backward", "combined"};
  return run(options_, direction, files, names[static_cast<int>(direction)], 0.0, from, to);
}

Expected<Series<sensors::GnssSample>> GnssEngine::run(const gnss::Options& options, Direction direction,
                                                      const std::vector<std::vector<File>>& observations,
                                                      const std::string& name, double seconds, double from, double to) {
  const fs::path configuration = workspace_.folder / (name + ".conf"), result = workspace_.folder / (name + ".pos");
  std::ofstream(configuration) << gnss::rtklib_configuration(options, direction);
  std::vector<std::string> arguments{"-k", configuration.string(), "-o", result.string()};
  const Span span = span_of(observations.front());
  if (seconds > 0.0) {
    const std::string end = to_text(span.first + Duration::from_seconds(seconds), TimeScale::gps);
    std::string date = end.substr(0, 10);
    std::replace(date.begin(), date.end(), '-', '/');
    arguments.insert(arguments.end(), {"-te", date, end.substr(11, 8)});
  }
  // The first name of observations is the rover, the second the base; several files of one of them need a wild card.
  for (const auto& group : observations) {
    arguments.push_back(
        (workspace_.folder / fmt::format("{}*.obs", group.front().path.filename().string()[0])).string());
  }
  for (const File& f : files_.navigation) arguments.push_back(f.path.string());
  const auto done = run_process(program_, arguments, [&](std::string_view line) {
    report(line, span, direction, from, to);
    return !progress_.cancelled();
  });
  if (!done) return tl::unexpected(done.error());
  if (done->exit_code != 0 || !fs::exists(result)) return fail(failed(program_, g_.rover.front(), *done));
  auto read = io::read_gnss({.table = {.path = result}, .format = io::GnssFile::Format::rtklib});
  if (!read) {
    return fail({.file = g_.rover.front().written,
                 .field = name,
                 .found = "no position at all (" + read.error().found + ")",
                 .expected = "satellites that rover and base have in common, with ephemerides",
                 .advice = "check systems, frequencies, elevation_mask_deg and the navigation files"});
  }
  return std::move(read->series);
}

/// "processing : 2023/01/08 10:09:47 Q=1"
void GnssEngine::report(std::string_view line, const Span& span, Direction direction, double from, double to) {
  const auto at = line.find("processing : ");
  if (at == std::string_view::npos || line.size() < at + 32) return;
  std::string date(line.substr(at + 13, 10));
  std::replace(date.begin(), date.end(), '/', '-');
  const auto time = parse_date_time(date + " " + std::string(line.substr(at + 24, 8)));
  if (!time) return;
  const double length = std::max(1.0, (span.last - span.first).seconds());
  double done = std::clamp((*time - gps_epoch_in_utc - span.first).seconds() / length, 0.0, 1.0);
  if (direction == Direction::backward) done = 1.0 - done;
  const std::lock_guard lock(mutex_);
  progress_.report("GNSS " + std::string(direction == Direction::forward ? "forward" : "processing"),
                   from + done * (to - from));
}

}  // namespace versine::app
