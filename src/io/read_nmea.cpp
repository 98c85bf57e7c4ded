// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "field_text.hpp"
#include "read_from.hpp"
#include "time_columns.hpp"
#include "versine/core/units.hpp"

// NMEA 0183, sentences GGA (position, quality), GST (sigmas), RMC (date, speed, course) and VTG (speed, course) of any
// talker. Sentences with one time make one epoch; the date comes from RMC, or from the clock's description.
namespace versine::io {

namespace {
using sensors::FixType;
using sensors::GnssSample;

struct Sentence {
  std::array<std::string_view, 24> field;
  std::size_t count = 0;
  [[nodiscard]] std::string_view operator[](std::size_t i) const { return i < count ? field[i] : std::string_view(); }
};

// XOR of everything between '$' and '*'.
bool checksum_holds(std::string_view body, std::string_view sum) {
  unsigned x = 0;
  for (const char c : body) x ^= static_cast<unsigned char>(c);
  return sum.size() >= 2 && fmt::format("{:02x}", x) == std::string{static_cast<char>(std::tolower(sum[0])),
                                                                    static_cast<char>(std::tolower(sum[1]))};
}

Sentence split(std::string_view body) {
  Sentence s;
  while (s.count < s.field.size()) {
    const std::size_t n = std::min(body.find(','), body.size());
    s.field[s.count++] = body.substr(0, n);
    if (n == body.size()) break;
    body.remove_prefix(n + 1);
  }
  return s;
}

// "hhmmss.sss"
std::optional<Duration> time_of_day(std::string_view text) {
  if (text.size() < 6) return std::nullopt;
  return parse_time_of_day(fmt::format("{}:{}:{}", text.substr(0, 2), text.substr(2, 2), text.substr(4)));
}

// "ddmmyy"
std::optional<Time> date(std::string_view text) {
  if (text.size() != 6) return std::nullopt;
  const bool last_century = text.substr(4) >= "80";
  return parse_date(
      fmt::format("{}{}-{}-{}", last_century ? "19" : "20", text.substr(4), text.substr(2, 2), text.substr(0, 2)));
}

// "ddmm.mmmm" and the letter of the hemisphere, rad.
std::optional<double> angle(std::string_view text, std::string_view hemisphere, double limit_deg) {
  const auto x = number(text);
  if (!x || !(*x >= 0.0) || hemisphere.size() != 1) return std::nullopt;
  const double degrees = std::floor(*x / 100.0), minutes = *x - 100.0 * degrees;
  const double value = degrees + minutes / 60.0;
  if (!(minutes < 60.0) || !(value <= limit_deg)) return std::nullopt;
  return (hemisphere == "S" || hemisphere == "W" ? -value : value) * units::deg;
}

FixType fix_of(std::string_view quality) {
  if (quality == "1" || quality == "3") return FixType::single;
  if (quality == "2") return FixType::differential;
  if (quality == "4") return FixType::fixed;
  if (quality == "5") return FixType::float_ambiguity;
  if (quality == "6") return FixType::dead_reckoned;
  return FixType::none;
}

/// What the sentences of one time tell.
struct Epoch {
  Duration rolled;  ///< time of day plus the days passed
  std::size_t line = 0;
  std::optional<geodesy::Geodetic> position;
  FixType fix = FixType::none;
  int satellites = 0;
  std::optional<double> hdop, speed, course;
  std::optional<Eigen::Vector3d> sigma;
};

/// Gathers sentences into epochs.
class Gatherer {
 public:
  explicit Gatherer(const GnssFile& file) {
    if (const auto given = parse_date(file.table.clock.date)) midnight_ = *given;
  }

  /// False when a field makes no sense.
  bool take(const Sentence& s, std::size_t line) {
    const std::string_view type = s[0].size() == 5 ? s[0].substr(2) : std::string_view();
    if (type == "VTG") return vtg(s);
    if (type != "GGA" && type != "RMC" && type != "GST") return true;
    if (s[1].empty()) return true;  // no time yet: the receiver has just been switched on
    const auto time = time_of_day(s[1]);
    if (!time) return false;
    if (!last_ || *last_ != *time) {
      epochs.push_back({.rolled = roll_over_(*time), .line = line});
      last_ = *time;
    }
    if (type == "GGA") return gga(s, epochs.back());
    if (type == "GST") return gst(s, epochs.back());
    return rmc(s, epochs.back());
  }

  std::vector<Epoch> epochs;
  [[nodiscard]] const std::optional<Time>& midnight() const { return midnight_; }
  [[nodiscard]] bool above_geoid() const { return above_geoid_; }

 private:
  bool gga(const Sentence& s, Epoch& epoch) {
    epoch.fix = fix_of(s[6]);
    if (epoch.fix == FixType::none) return true;
    const auto latitude = angle(s[2], s[3], 90.0), longitude = angle(s[4], s[5], 180.0), altitude = number(s[9]);
    if (!latitude || !longitude || !altitude) return false;
    const auto separation = number(s[11]);
    above_geoid_ = above_geoid_ || !separation;
    epoch.position = {*latitude, *longitude, *altitude + separation.value_or(0.0)};
    epoch.satellites = static_cast<int>(std::min(number(s[7]).value_or(0.0), 999.0));
    epoch.hdop = number(s[8]);
    return true;
  }
  bool gst(const Sentence& s, Epoch& epoch) const {
    const auto north = number(s[6]), east = number(s[7]), up = number(s[8]);
    if (north && east && up) epoch.sigma = Eigen::Vector3d(*north, *east, *up);
    return true;
  }
  bool rmc(const Sentence& s, Epoch& epoch) {
    const auto day = date(s[9]);
    if (!day) return s[9].empty();
    if (!midnight_) midnight_ = *day + *last_ - epoch.rolled;
    if (const auto knots = number(s[7]), course = number(s[8]); knots && course) {
      epoch.speed = *knots * 1852.0 / 3600.0;
      epoch.course = *course * units::deg;
    }
    return true;
  }
  bool vtg(const Sentence& s) {
    const auto course = number(s[1]), kmh = number(s[7]);
    if (!epochs.empty() && course && kmh)
      epochs.back().speed = *kmh * units::kmh, epochs.back().course = *course * units::deg;
    return true;
  }

  RollOver roll_over_{one_day};
  std::optional<Duration> last_;
  std::optional<Time> midnight_;
  bool above_geoid_ = false;
};

// The file's own sigmas, else dilution of precision, else what was given for the file.
std::optional<Eigen::Vector3d> sigma_of(const Epoch& epoch, const GnssFile& file) {
  if (epoch.sigma) return epoch.sigma;
  if (file.sigma_horizontal && file.sigma_vertical) {
    return Eigen::Vector3d(*file.sigma_horizontal, *file.sigma_horizontal, *file.sigma_vertical);
  }
  if (!file.sigma_range || !epoch.hdop) return std::nullopt;
  const double level = *epoch.hdop * *file.sigma_range * std::sqrt(0.5);
  return Eigen::Vector3d(level, level, 2.0 * *epoch.hdop * *file.sigma_range);  // the vertical is about twice as weak
}
}  // namespace

Expected<Read<Series<GnssSample>>> read_nmea(LineReader lines, const GnssFile& file) {
  Gatherer gatherer(file);
  FaultLog faults;
  std::size_t good = 0;
  std::string_view line;
  while (lines.next(line)) {
    const std::size_t start = line.find('$');
    if (start == line.npos) continue;
    const std::size_t star = line.find('*', start);
    const std::string_view body = line.substr(start + 1, (star == line.npos ? line.size() : star) - start - 1);
    if (star != line.npos && !checksum_holds(body, line.substr(star + 1))) {
      faults.add("checksum", lines.line_number(), "");
    } else if (!gatherer.take(split(body), lines.line_number())) {
      faults.add("garbled sentence", lines.line_number(), "");
    } else {
      ++good;
    }
  }
  if (lines.error()) return fail(*lines.error());
  if (const auto fine = faults.tolerable(lines.name(), good); !fine) return tl::unexpected(fine.error());
  if (!gatherer.midnight()) {
    return fail({.file = lines.name(),
                 .field = "date",
                 .found = "no date (no RMC sentence with a date)",
                 .expected = "the date of the first sentence",
                 .advice = "record RMC too, or set date = \"2025-07-08\" beside the file"});
  }
  Read<Series<GnssSample>> read;
  ClockCorrection correction(file.table.clock);
  std::size_t without_fix = 0;
  for (const Epoch& epoch : gatherer.epochs) {
    const Time time = correction(gps_from_utc(*gatherer.midnight() + epoch.rolled));
    if (!epoch.position) {
      ++without_fix;
      continue;
    }
    const auto sigma = sigma_of(epoch, file);
    if (!sigma || !(sigma->minCoeff() > 0.0)) {
      return fail({.file = lines.name(),
                   .line = epoch.line,
                   .field = "sigma",
                   .found = sigma ? "a standard deviation that is not positive" : "no standard deviation",
                   .expected = "positive values in GST, or sigmas for the whole file",
                   .advice = "set sigma_horizontal_m and sigma_vertical_m, or sigma_range_m for HDOP"});
    }
    GnssSample sample{.time = time,
                      .position = *epoch.position,
                      .sigma_ned = *sigma,
                      .fix = epoch.fix,
                      .satellites = epoch.satellites};
    if (epoch.speed && epoch.course && file.sigma_velocity) {
      // Sentences tell no vertical speed; 10 m/s says that nothing is known about it.
      sample.v_ned =
          Eigen::Vector3d(*epoch.speed * std::cos(*epoch.course), *epoch.speed * std::sin(*epoch.course), 0.0);
      sample.sigma_v_ned = {*file.sigma_velocity, *file.sigma_velocity, 10.0};
    }
    faults.now(time);
    read.series.samples.push_back(sample);
  }
  if (read.series.empty()) {
    return fail({.file = lines.name(),
                 .found = fmt::format("{} epochs without a position", without_fix),
                 .expected = "GGA sentences with a fix",
                 .advice = "record GGA; check the antenna"});
  }
  faults.report("gnss", read.record);
  if (without_fix > 0)
    read.record.warnings.push_back(fmt::format("{}: {} epochs without a fix", lines.name(), without_fix));
  if (gatherer.above_geoid()) {
    read.record.warnings.push_back(
        lines.name() + ": GGA without geoid separation; heights are above the geoid there, not the ellipsoid");
  }
  read.series.scale = TimeScale::gps;
  return read;
}

}  // namespace versine::io
