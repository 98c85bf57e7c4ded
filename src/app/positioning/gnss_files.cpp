// SPDX-License-Identifier: Apache-2.0
#include "gnss_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "versine/core/calendar.hpp"
#include "versine/io/input_stream.hpp"

namespace versine::app::gnss_files {

namespace fs = std::filesystem;
using gnss::RinexScan;

Workspace::Workspace() {
  std::random_device random;
  folder = fs::temp_directory_path() / fmt::format("versine-gnss-{:08x}{:08x}", random(), random());
  fs::create_directories(folder);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

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

namespace {
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

}  // namespace

Expected<Files> prepare(const GnssProcessing& g, const Workspace& workspace, Progress& progress) {
  return Preparation(workspace, progress).prepare(g);
}

Span span_of(const std::vector<File>& files) {
  Span s{files.front().scan.first, files.front().scan.last};
  for (const File& f : files) s = {std::min(s.first, f.scan.first), std::max(s.last, f.scan.last)};
  return s;
}

Expected<void> check(const GnssProcessing& g, const Files& files) {
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

}  // namespace versine::app::gnss_files
