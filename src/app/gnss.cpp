// SPDX-License-Identifier: Apache-2.0
#include "versine/app/gnss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <future>
#include <mutex>
#include <random>

#include "versine/core/calendar.hpp"
#include "versine/core/process.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/gnss/rinex_scan.hpp"
#include "versine/io/input_stream.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {
namespace {

using gnss::Direction;
using gnss::RinexScan;
namespace fs = std::filesystem;

/// A folder of our own that goes away with us.
struct Workspace {
  fs::path folder;
  Workspace() {
    std::random_device random;
    folder = fs::temp_directory_path() / fmt::format("versine-gnss-{:08x}{:08x}", random(), random());
    fs::create_directories(folder);
  }
  ~Workspace() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
};

struct File {
  fs::path path;
  RinexScan scan;
};
/// Everything that RTKLIB reads, as plain RINEX.
struct Files {
  std::vector<File> rover, base, navigation;
};

Expected<fs::path> need_program(std::initializer_list<std::string_view> names, const std::string& advice) {
  for (const auto name : names) {
    if (auto path = find_program(name)) return *path;
  }
  return fail({.field = std::string(*names.begin()),
               .found = "no such program on PATH",
               .expected = "RTKLIB's programs",
               .advice = advice});
}

Error failed(const fs::path& program, const InputPath& input, const ProcessResult& r) {
  return {.file = input.written,
          .found = fmt::format("{} ended with code {}: {}", program.filename().string(), r.exit_code,
                               r.output.substr(r.output.size() > 300 ? r.output.size() - 300 : 0)),
          .expected = "data that it can read",
          .advice = "is the file complete, and of the kind that its first bytes say?"};
}

class Preparation {
 public:
  Preparation(const Workspace& workspace, Progress& progress) : workspace_(workspace), progress_(progress) {}

  Expected<Files> prepare(const GnssProcessing& g) {
    for (const auto& [inputs, role] : {std::pair{&g.rover, 'r'}, {&g.base, 'b'}, {&g.navigation, 'n'}}) {
      for (const InputPath& input : *inputs) {
        if (auto done = add(input, role); !done) return tl::unexpected(done.error());
      }
    }
    return std::move(files_);
  }

 private:
  fs::path fresh(std::string_view extension) const {
    return workspace_.folder / fmt::format("input{}{}", counter_++, extension);
  }

  Expected<void> add(const InputPath& input, char role) {
    progress_.report("reading GNSS data", 0.0);
    auto text = io::read_text(input.path);
    if (!text) return tl::unexpected(text.error());
    switch (gnss::raw_kind(*text)) {
      case gnss::RawKind::rinex:
        return add_rinex(*text, input, role);
      case gnss::RawKind::hatanaka:
        return add_hatanaka(*text, input, role);
      case gnss::RawKind::ublox:
        return add_raw(*text, input, role, "ubx");
      case gnss::RawKind::novatel:
        return add_raw(*text, input, role, "nov");
      case gnss::RawKind::unknown:
        break;
    }
    return fail({.file = input.written,
                 .line = 1,
                 .found = "neither RINEX nor u-blox or NovAtel raw data",
                 .expected = "RINEX 2 or 3, Hatanaka, u-blox (.ubx) or NovAtel (.gps) data",
                 .advice = "convert the receiver's file to RINEX with its maker's program"});
  }

  Expected<void> add_rinex(const std::string& text, const InputPath& input, char role) {
    auto scan = gnss::scan_rinex(text, input.written);
    if (!scan) return tl::unexpected(scan.error());
    const bool observation = scan->kind == RinexScan::Kind::observation;
    if (observation != (role != 'n')) {
      return fail({.file = input.written,
                   .found = observation ? "observations among the navigation files" : "a navigation file",
                   .expected = role == 'n' ? "RINEX navigation data" : "RINEX observations",
                   .advice = "put the file under the other key (rover, base or navigation)"});
    }
    const fs::path path = workspace_.folder / fmt::format("{}{}.{}", role, counter_++, observation ? "obs" : "nav");
    std::ofstream(path, std::ios::binary) << text;
    (role == 'r' ? files_.rover : role == 'b' ? files_.base : files_.navigation).push_back({path, *scan});
    return {};
  }

  Expected<void> add_hatanaka(const std::string& text, const InputPath& input, char role) {
    const auto program = need_program(
        {"crx2rnx", "CRX2RNX"}, "this file is Hatanaka-compressed: install RNXCMP (crx2rnx), or expand it to RINEX");
    if (!program) return tl::unexpected(program.error());
    const fs::path packed = fresh(".crx");
    std::ofstream(packed, std::ios::binary) << text;
    const std::vector<std::string> arguments{"-f", packed.string()};
    const auto done = run_process(*program, arguments, [](std::string_view) { return true; });
    if (!done) return tl::unexpected(done.error());
    fs::path plain = packed;
    auto expanded = io::read_text(plain.replace_extension(".rnx"));
    if (!expanded) return fail(failed(*program, input, *done));
    return add_rinex(*expanded, input, role);
  }

  /// convbin makes observations and ephemerides from a receiver's own format.
  Expected<void> add_raw(const std::string& text, const InputPath& input, char role, const std::string& format) {
    const auto program = need_program({"convbin"}, "install RTKLIB (Debian: apt install rtklib)");
    if (!program) return tl::unexpected(program.error());
    const fs::path raw = fresh(".raw"), observations = fresh(".obs"), navigation = fresh(".nav");
    std::ofstream(raw, std::ios::binary) << text;
    const std::vector<std::string> arguments{
        "-r", format, "-v", "3.03", "-od", "-os", "-o", observations.string(), "-n", navigation.string(), raw.string()};
    const auto done = run_process(*program, arguments, [this](std::string_view) { return !progress_.cancelled(); });
    if (!done) return tl::unexpected(done.error());
    const auto made = io::read_text(observations);
    if (done->exit_code != 0 || !made) return fail(failed(*program, input, *done));
    if (auto added = add_rinex(*made, input, role); !added) return added;
    if (const auto ephemerides = io::read_text(navigation)) {
      const auto scan = gnss::scan_rinex(*ephemerides, input.written);
      if (scan) files_.navigation.push_back({navigation, *scan});
    }
    return {};
  }

  const Workspace& workspace_;
  Progress& progress_;
  mutable int counter_ = 0;
  Files files_;
};

struct Span {
  Time first, last;
};
Span span_of(const std::vector<File>& files) {
  Span s{files.front().scan.first, files.front().scan.last};
  for (const File& f : files) s = {std::min(s.first, f.scan.first), std::max(s.last, f.scan.last)};
  return s;
}

Expected<void> check_files(const GnssProcessing& g, const Files& files) {
  if (files.rover.empty()) {
    return fail({.field = "gnss.rover",
                 .found = "nothing",
                 .expected = "at least one file",
                 .advice = "name the rover's observations"});
  }
  const bool relative = g.options.positioning != gnss::Positioning::single;
  if (relative && files.base.empty()) {
    return fail({.field = "gnss.base",
                 .found = "nothing",
                 .expected = "observations of a base station",
                 .advice = "name the base's file, or set mode = \"single\""});
  }
  if (files.navigation.empty()) {
    return fail(
        {.field = "gnss.navigation",
         .found = "no navigation data",
         .expected = "ephemerides of the day (RINEX navigation)",
         .advice = "name the receiver's .nav file, or the day's broadcast ephemerides (BRDC) of an IGS archive"});
  }
  const Span rover = span_of(files.rover), ephemerides = span_of(files.navigation);
  const Duration validity{14'400 * one_second.ns};
  if (ephemerides.last + validity < rover.first || rover.last + validity < ephemerides.first) {
    return fail({.file = g.navigation.empty() ? "" : g.navigation.front().written,
                 .field = "navigation data",
                 .found = fmt::format("ephemerides from {} to {}", to_text(ephemerides.first, TimeScale::gps),
                                      to_text(ephemerides.last, TimeScale::gps)),
                 .expected = fmt::format("around {} (the rover's first epoch)", to_text(rover.first, TimeScale::gps)),
                 .advice = "take the navigation file of the day of the measurement"});
  }
  if (!relative) return {};
  const Span base = span_of(files.base);
  if (base.last < rover.first || rover.last < base.first) {
    return fail(
        {.file = g.base.front().written,
         .field = "base observations",
         .found = fmt::format("from {} to {}", to_text(base.first, TimeScale::gps), to_text(base.last, TimeScale::gps)),
         .expected = fmt::format("a time in common with the rover, {} to {}", to_text(rover.first, TimeScale::gps),
                                 to_text(rover.last, TimeScale::gps)),
         .advice = "take the base's file of the same hours"});
  }
  return {};
}

class Engine {
 public:
  Engine(const GnssProcessing& g, const Files& files, const Workspace& workspace, fs::path program, Progress& progress)
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

  [[nodiscard]] const gnss::Options& options() const { return options_; }

  /// The base's code solution over its first ten minutes, ECEF; nothing when it has none.
  Expected<std::optional<Eigen::Vector3d>> base_by_code() {
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

  Expected<void> check_base() {
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

  Expected<Series<sensors::GnssSample>> solve(Direction direction, double from, double to) {
    auto files = std::vector<std::vector<File>>{files_.rover};
    if (options_.positioning != gnss::Positioning::single) files.push_back(files_.base);
    static constexpr const char* names[] = {"forward", "backward", "combined"};
    return run(options_, direction, files, names[static_cast<int>(direction)], 0.0, from, to);
  }

 private:
  Expected<Series<sensors::GnssSample>> run(const gnss::Options& options, Direction direction,
                                            const std::vector<std::vector<File>>& observations, const std::string& name,
                                            double seconds, double from, double to) {
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
  void report(std::string_view line, const Span& span, Direction direction, double from, double to) {
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

  const GnssProcessing& g_;
  const Files& files_;
  const Workspace& workspace_;
  fs::path program_;
  Progress& progress_;
  std::mutex mutex_;
  gnss::Options options_;
};

}  // namespace

Expected<GnssResult> process_gnss(const GnssProcessing& g, Progress& progress, Log& log) {
  const auto program = need_program({"rnx2rtkp"}, "install RTKLIB (Debian: apt install rtklib)");
  if (!program) return tl::unexpected(program.error());
  const Workspace workspace;
  const auto files = Preparation(workspace, progress).prepare(g);
  if (!files) return tl::unexpected(files.error());
  if (auto ok = check_files(g, *files); !ok) return tl::unexpected(ok.error());
  Engine engine(g, *files, workspace, *program, progress);
  const bool relative = g.options.positioning != gnss::Positioning::single;
  if (relative) {
    if (auto ok = engine.check_base(); !ok) return tl::unexpected(ok.error());
  }

  GnssResult out;
  for (const File& f : files->rover) out.epochs += f.scan.epochs;
  out.configuration = gnss::rtklib_configuration(engine.options(), g.direction);
  const bool both = relative && g.direction == Direction::combined;
  auto forward = std::async(both ? std::launch::async : std::launch::deferred,
                            [&] { return engine.solve(Direction::forward, 0.05, 0.5); });
  auto backward = std::async(both ? std::launch::async : std::launch::deferred,
                             [&] { return engine.solve(Direction::backward, 0.05, 0.5); });
  auto wanted = engine.solve(relative ? g.direction : Direction::forward, 0.05, 1.0);
  if (!wanted) return tl::unexpected(wanted.error());
  out.series = std::move(*wanted);
  std::sort(out.series.samples.begin(), out.series.samples.end(),
            [](const auto& a, const auto& b) { return a.time < b.time; });
  if (both) {
    const auto f = forward.get(), b = backward.get();
    if (!f) return tl::unexpected(f.error());
    if (!b) return tl::unexpected(b.error());
    auto agreement = gnss::compare_directions(std::move(out.series), *f, *b, g.agreement);
    out.series = std::move(agreement.series);
    out.fixed = agreement.fixed;
    out.confirmed = agreement.confirmed;
    out.doubted = agreement.doubted;
    out.record.findings = std::move(agreement.findings);
  } else {
    for (const auto& s : out.series) out.fixed += s.fix == sensors::FixType::fixed;
  }
  if (out.series.size() < out.epochs) {
    out.record.warnings.push_back(fmt::format("{} of {} epochs have a position", out.series.size(), out.epochs));
  }
  for (const auto& w : out.record.warnings) log.warn(w);
  return out;
}

}  // namespace versine::app
