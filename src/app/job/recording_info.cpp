// SPDX-License-Identifier: Apache-2.0
#include "versine/app/recording_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"
#include "versine/io/line_reader.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::app {

namespace {

template <class Samples>
TimeInfo time_info(const Samples& samples, TimeScale scale) {
  TimeInfo info{.scale = scale, .from = samples.front().time, .to = samples.front().time};
  std::vector<std::int64_t> steps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    info.from = std::min(info.from, samples[i].time);
    info.to = std::max(info.to, samples[i].time);
    if (i == 0) continue;
    const Duration step = samples[i].time - samples[i - 1].time;
    if (step.ns > 0) {
      steps.push_back(step.ns);
    } else {
      ++info.out_of_order;
    }
    info.longest_gap = std::max(info.longest_gap, step);
  }
  if (steps.empty()) return info;
  std::vector<std::int64_t> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  info.interval = {*middle};
  for (const std::int64_t step : steps) info.gaps += 2 * step > 3 * info.interval.ns ? 1 : 0;
  return info;
}

const char* name_of(sensors::FixType fix) {
  switch (fix) {
    case sensors::FixType::none:
      return "none";
    case sensors::FixType::single:
      return "single";
    case sensors::FixType::differential:
      return "differential";
    case sensors::FixType::float_ambiguity:
      return "float";
    case sensors::FixType::fixed:
      return "fixed";
    case sensors::FixType::dead_reckoned:
      return "dead reckoned";
  }
  return "none";
}

void extend(RecordingInfo& info, const geodesy::Geodetic& g) {
  if (!info.box) info.box = {g, g};
  auto& [low, high] = *info.box;
  low = {std::min(low.latitude, g.latitude), std::min(low.longitude, g.longitude), std::min(low.height, g.height)};
  high = {std::max(high.latitude, g.latitude), std::max(high.longitude, g.longitude), std::max(high.height, g.height)};
}

void take_findings(RecordingInfo& info, const RunRecord& record) {
  for (const Finding& f : record.findings) {
    info.findings.push_back(fmt::format("{}: {} ({} {})", f.kind, f.count, f.detail, to_string(f.action)));
  }
  info.findings.insert(info.findings.end(), record.warnings.begin(), record.warnings.end());
}

Expected<RecordingInfo> gnss_info(const std::filesystem::path& path, io::GnssFile::Format format, RecordingInfo info) {
  io::GnssFile file;
  file.table.path = path;
  file.format = format;
  // Only what is in the file is shown; these stand in for sigmas that it does not give.
  file.sigma_horizontal = file.sigma_vertical = file.sigma_velocity = 1.0;
  const auto read = io::read_gnss(file);
  if (!read) return tl::unexpected(read.error());
  std::map<std::string, std::size_t> fixes;
  for (const sensors::GnssSample& s : read->series) {
    extend(info, s.position);
    ++fixes[name_of(s.fix)];
  }
  info.fixes.assign(fixes.begin(), fixes.end());
  info.samples = read->series.size();
  info.time = time_info(read->series.samples, read->series.scale);
  take_findings(info, read->record);
  return info;
}

Expected<RecordingInfo> trajectory_info(const std::filesystem::path& path, RecordingInfo info) {
  io::TrajectoryFile file;
  file.table.path = path;
  const auto read = io::read_trajectory(file);
  if (!read) return tl::unexpected(read.error());
  info.format = "trajectory (HDF5): " + read->series.origin;
  info.samples = read->series.size();
  for (const auto& p : read->series) extend(info, p.position);
  if (info.samples > 0) info.time = time_info(read->series.samples, read->series.scale);
  return info;
}

// Names that readers look for (docs/formats.md).
constexpr std::array<std::string_view, 48> known_columns{
    "time",           "tow",           "gps_week",      "week",        "time_of_day", "time_utc",   "timestamp",
    "datetime",       "gyro_x",        "gyro_y",        "gyro_z",      "accel_x",     "accel_y",    "accel_z",
    "dtheta_x",       "dtheta_y",      "dtheta_z",      "dvel_x",      "dvel_y",      "dvel_z",     "latitude",
    "longitude",      "height",        "north",         "east",        "down",        "up",         "easting",
    "northing",       "hdop",          "vdop",          "sigma_north", "sigma_east",  "sigma_down", "sigma_up",
    "velocity_north", "velocity_east", "velocity_down", "velocity_up", "distance",    "count",      "speed",
    "gauge",          "temperature",   "range",         "heading",     "roll",        "pitch"};

/// Running statistics of a column.
struct Column {
  io::TableReader::Slot slot = 0;
  ColumnInfo info;
  double sum = 0.0;
  void take(std::string_view field) {
    double x = 0.0;
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), x);
    if (field.empty() || (code == std::errc() && end == field.data() + field.size() && !std::isfinite(x))) {
      ++info.missing;
    } else if (code != std::errc() || end != field.data() + field.size()) {
      if (info.example.empty()) info.example = field;
    } else {
      info.min = info.numbers == 0 ? x : std::min(info.min, x);
      info.max = info.numbers == 0 ? x : std::max(info.max, x);
      sum += x;
      ++info.numbers;
    }
  }
};

// A table without header, by column numbers.
std::map<std::string, std::string> numbered_columns(const std::filesystem::path& path) {
  std::map<std::string, std::string> columns;
  auto lines = io::LineReader::open(path);
  std::string_view line;
  while (lines && lines->next(line)) {
    const auto first = line.find_first_not_of(" \t");
    if (first == line.npos || line[first] == '#' || line[first] == '%') continue;
    bool inside = false;
    std::size_t fields = 0;
    for (const char c : line) {
      const bool divides = c == ' ' || c == '\t' || c == ',' || c == ';';
      if (!divides && !inside) ++fields;
      inside = !divides;
    }
    for (std::size_t i = 1; i <= fields; ++i) columns[fmt::format("column{}", i)] = std::to_string(i);
    break;
  }
  return columns;
}

// Whether three means are gravity in some unit, and which.
std::optional<std::pair<double, const char*>> gravity_unit(double size, double interval) {
  constexpr double g = units::standard_gravity;
  std::vector<std::pair<double, const char*>> known{{1.0, "g"}, {g, "mps2"}, {1000.0, "mg"}};
  if (interval > 0.0) known.push_back({g * interval, "mps, increments of velocity (dvel)"});
  for (const auto& [value, unit] : known) {
    if (std::abs(size / value - 1.0) < 0.06) return std::pair{value, unit};
  }
  return std::nullopt;
}

void guess_gravity(RecordingInfo& info) {
  const double interval = info.time ? info.time->interval.seconds() : 0.0;
  for (std::size_t i = 0; i + 2 < info.columns.size(); ++i) {
    const auto* c = &info.columns[i];
    if (c[0].numbers == 0 || c[1].numbers == 0 || c[2].numbers == 0) continue;
    const bool named = c[0].name.find("acc") != std::string::npos || c[0].name.find("dvel") != std::string::npos ||
                       c[0].name.starts_with("column");
    const std::array mean{c[0].mean, c[1].mean, c[2].mean};
    const double size = std::hypot(mean[0], mean[1], mean[2]);
    const auto unit = gravity_unit(size, interval);
    const auto at = static_cast<std::size_t>(
        std::max_element(mean.begin(), mean.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        mean.begin());
    if (!named || !unit || std::abs(mean[at]) < 0.8 * size) continue;
    // Gravity is steady; the noise of a gyroscope may have any mean.
    if (c[at].max - c[at].min > 4.0 * std::abs(mean[at])) continue;
    const char* const axis[] = {"x", "y", "z"};
    const bool up = mean[at] > 0.0;
    info.guesses.push_back(
        {fmt::format("'{}', '{}', '{}' are accelerometers in {}", c[0].name, c[1].name, c[2].name, unit->second),
         fmt::format("their mean has the length {:.4g}, gravity in that unit is {:.4g}", size, unit->first)});
    info.guesses.push_back(
        {fmt::format("the sensor's {} points {}: axes such as \"{}\"", axis[at], up ? "up" : "down",
                     at == 2   ? (up ? "right-forward-up" : "forward-right-down")
                     : at == 1 ? (up ? "forward-up-right" : "right-down-forward")
                               : (up ? "up-forward-left" : "down-right-backward")),
         fmt::format("'{}' reads {:.4g} on average, {} 1 g; gravity cannot tell which way is forward", c[at].name,
                     mean[at], up ? "plus" : "minus")});
    return;
  }
}

void guess_gyro_unit(RecordingInfo& info) {
  for (const ColumnInfo& column : info.columns) {
    const bool gyro = column.name.find("gyr") != std::string::npos;
    if (!gyro || !column.versines.empty() || column.numbers == 0) continue;
    const double size = std::max(std::abs(column.min), std::abs(column.max));
    info.guesses.push_back({fmt::format("'{}' is in {}", column.name, size > 6.3 ? "deg/s" : "rad/s or deg/s"),
                            fmt::format("its largest value is {:.4g}; {}", size,
                                        size > 6.3 ? "a vehicle does not turn a full circle in a second"
                                                   : "name the unit in the column's name or in [columns]")});
    return;
  }
}

// Times of the table, when its columns make one.
std::optional<TimeInfo> table_times(const std::filesystem::path& path, const io::TableFile& file) {
  io::SpeedFile as_speed;  // a reader of a time and one number
  as_speed.table = file;
  as_speed.table.path = path;
  auto lines = io::LineReader::open(path);
  if (!lines) return std::nullopt;
  auto table = io::TableReader::open(std::move(*lines), as_speed.table);
  if (!table) return std::nullopt;
  for (const char* base : {"time", "tow", "time_of_day"}) {
    const auto slot = table->find_time(base);
    if (!slot || !*slot) continue;
    struct Stamp {
      Time time;
    };
    std::vector<Stamp> stamps;
    while (table->next()) {
      const std::int64_t ns = table->nanoseconds(**slot);
      if (ns != io::TableReader::missing) stamps.push_back({{ns}});
    }
    if (stamps.empty() || table->error()) return std::nullopt;
    const bool gps = std::string_view(base) == "time" && stamps.front().time.ns > 100'000'000 * one_second.ns;
    return time_info(stamps, gps ? TimeScale::gps : TimeScale::recorder);
  }
  return std::nullopt;
}

Expected<RecordingInfo> table_info(const std::filesystem::path& path, RecordingInfo info) {
  io::TableFile file{.path = path};
  auto lines = io::LineReader::open(path);
  if (!lines) return tl::unexpected(lines.error());
  auto table = io::TableReader::open(std::move(*lines), file);
  const bool headerless = !table;
  if (headerless) {
    file.columns = numbered_columns(path);
    auto again = io::LineReader::open(path);
    if (!again) return tl::unexpected(again.error());
    const Error first = table.error();
    table = io::TableReader::open(std::move(*again), file);
    if (!table) return fail(first);
  }
  std::vector<Column> columns;
  for (std::size_t i = 0; i < table->written().size(); ++i) {
    Column column{.slot = table->text_column(i)};
    column.info.name = headerless ? fmt::format("column {}", i + 1) : table->written()[i];
    const auto name = io::split_column_name(table->header()[i]);
    const bool known = std::find(known_columns.begin(), known_columns.end(), name.base) != known_columns.end();
    if (!headerless && known) column.info.versines = table->header()[i];
    columns.push_back(std::move(column));
  }
  while (table->next()) {
    for (Column& column : columns) column.take(table->text(column.slot));
  }
  if (table->error()) return fail(*table->error());
  info.samples = table->rows();
  if (const auto fine = table->faults().tolerable(table->name(), table->rows()); !fine)
    return tl::unexpected(fine.error());
  if (std::all_of(columns.begin(), columns.end(), [](const Column& c) { return c.info.numbers == 0; })) {
    return fail({.file = table->name(),
                 .found = "no column of numbers",
                 .expected = "a recording: CSV, RTKLIB .pos, NMEA 0183 or trajectory.h5",
                 .advice = "name a file that a sensor wrote; docs/formats.md describes what can be read"});
  }
  const char divider = table->delimiter();
  info.format = fmt::format("table {}, divided by {}", headerless ? "without header" : "with header",
                            divider == ' '    ? "blanks"
                            : divider == '\t' ? "tabs"
                                              : fmt::format("'{}'", divider));
  RunRecord record;
  table->faults().report("", record);
  take_findings(info, record);
  for (Column& column : columns) {
    column.info.mean = column.info.numbers > 0 ? column.sum / static_cast<double>(column.info.numbers) : 0.0;
    info.columns.push_back(column.info);
  }
  info.time = table_times(path, file);
  guess_gravity(info);
  guess_gyro_unit(info);
  return info;
}
}  // namespace

Expected<RecordingInfo> recording_info(const std::filesystem::path& path) {
  RecordingInfo info{.path = path};
  auto lines = io::LineReader::open(path);
  if (!lines) return tl::unexpected(lines.error());
  std::ifstream raw(path, std::ios::binary);
  char mark[4] = {};
  raw.read(mark, sizeof mark);
  if (std::string_view(mark, 4) == "\x89HDF") return trajectory_info(path, info);
  std::string_view line;
  while (lines->next(line)) {
    if (line.starts_with("$") && line.size() > 6 && line.find(',') != line.npos) {
      info.format = "NMEA 0183";
      return gnss_info(path, io::GnssFile::Format::nmea, info);
    }
    if (!line.starts_with("%") && !line.empty()) break;
    if (line.find("GPST") != line.npos || line.find("latitude(deg)") != line.npos) {
      info.format = "RTKLIB solution";
      return gnss_info(path, io::GnssFile::Format::rtklib, info);
    }
  }
  if (lines->error()) return fail(*lines->error());
  return table_info(path, info);
}

}  // namespace versine::app
