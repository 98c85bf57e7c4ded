// SPDX-License-Identifier: Apache-2.0
#include "versine/gnss/rinex_scan.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>

#include "versine/core/calendar.hpp"

namespace versine::gnss {
namespace {

std::optional<double> number(std::string_view s) {
  const auto a = s.find_first_not_of(' ');
  if (a == std::string_view::npos) return {};
  s = s.substr(a, s.find_last_not_of(' ') - a + 1);
  double v = 0.0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), v);
  if (error != std::errc() || end != s.data() + s.size()) return {};
  return v;
}

/// Date and time in fixed columns of `width`, the year's own width before it.
std::optional<Time> epoch(std::string_view line, std::size_t from, std::size_t year_width, std::size_t second_width) {
  const std::size_t rest = from + year_width;
  if (line.size() < rest + 12 + second_width) return {};
  const auto year = number(line.substr(from, year_width));
  double field[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const auto v = number(line.substr(rest + 3 * i, 3));
    if (!v) return {};
    field[i] = *v;
  }
  const auto second = number(line.substr(rest + 12, second_width));
  if (!year || !second || *second >= 61.0) return {};
  const int y = static_cast<int>(*year) + (*year < 80 ? 2000 : *year < 100 ? 1900 : 0);
  const auto date = parse_date(fmt::format("{:04d}-{:02.0f}-{:02.0f}", y, field[0], field[1]));
  if (!date) return {};
  return *date - gps_epoch_in_utc + Duration::from_seconds(3600.0 * field[2] + 60.0 * field[3] + *second);
}

/// An epoch line of observations: '>' in RINEX 3; in RINEX 2 a decimal point of the seconds where no observation has
/// one.
std::optional<Time> observation_epoch(std::string_view line, bool three) {
  if (three) return line.starts_with('>') ? epoch(line, 2, 4, 11) : std::nullopt;
  if (line.size() < 32 || line[18] != '.' || line[10] == '.' || line[28] > '1') return {};
  return epoch(line, 1, 2, 11);
}

std::optional<Time> ephemeris_epoch(std::string_view line, bool three) {
  if (line.size() < 23) return {};
  if (three) return line[0] == ' ' ? std::nullopt : epoch(line, 4, 4, 3);
  return line[1] >= '0' && line[1] <= '9' ? epoch(line.substr(0, 22), 3, 2, 5) : std::nullopt;
}

void read_header_line(std::string_view line, RinexScan& scan) {
  const std::string_view label = line.size() > 60 ? line.substr(60) : std::string_view{};
  if (label.starts_with("RINEX VERSION")) {
    scan.version = number(line.substr(0, 9)).value_or(0.0);
    scan.kind = line[20] == 'O' ? RinexScan::Kind::observation : RinexScan::Kind::navigation;
  } else if (label.starts_with("APPROX POSITION XYZ")) {
    Eigen::Vector3d x(number(line.substr(0, 14)).value_or(0.0), number(line.substr(14, 14)).value_or(0.0),
                      number(line.substr(28, 14)).value_or(0.0));
    if (x.norm() > 1e6) scan.approximate = x;
  } else if (label.starts_with("MARKER NAME")) {
    scan.marker = std::string(line.substr(0, line.substr(0, 60).find_last_not_of(' ') + 1));
  }
}

}  // namespace

RawKind raw_kind(std::string_view content) {
  const auto start = content.substr(0, 4096);
  if (start.find("RINEX VERSION") != std::string_view::npos) return RawKind::rinex;
  if (start.find("CRINEX VERS") != std::string_view::npos) return RawKind::hatanaka;
  if (start.find("\xB5\x62") != std::string_view::npos) return RawKind::ublox;
  if (start.find("\xAA\x44\x12") != std::string_view::npos) return RawKind::novatel;
  return RawKind::unknown;
}

Expected<RinexScan> scan_rinex(std::string_view text, const std::string& name) {
  RinexScan scan;
  bool header = true;
  std::map<std::int64_t, std::size_t> spacing;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (header) {
      read_header_line(line, scan);
      header = line.size() < 73 || !line.substr(60).starts_with("END OF HEADER");
      continue;
    }
    const bool three = scan.version >= 3.0;
    const auto t =
        scan.kind == RinexScan::Kind::observation ? observation_epoch(line, three) : ephemeris_epoch(line, three);
    if (!t) continue;
    if (scan.epochs > 0 && *t > scan.last) ++spacing[(*t - scan.last).ns / 1'000'000];
    if (scan.epochs == 0 || *t < scan.first) scan.first = *t;
    if (scan.epochs == 0 || *t > scan.last) scan.last = *t;
    ++scan.epochs;
  }
  if (scan.version <= 0.0 || header || scan.epochs == 0) {
    return fail({.file = name,
                 .found = scan.version <= 0.0 ? "no RINEX header"
                          : header            ? "a header that does not end"
                                              : "no epoch",
                 .expected = "a complete RINEX 2 or 3 file",
                 .advice = "was the file cut short when it was copied? Convert it again from the receiver's data"});
  }
  std::size_t most = 0;
  for (const auto& [ms, count] : spacing) {
    if (count > most) most = count, scan.interval = 1e-3 * static_cast<double>(ms);
  }
  return scan;
}

}  // namespace versine::gnss
