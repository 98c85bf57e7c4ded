// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "field_text.hpp"
#include "read_from.hpp"
#include "time_columns.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"

// RTKLIB's solution file (RTKLIB 2.4.3 manual, appendix B.2): comment lines with '%', the last of them naming the
// columns; time as week and seconds or as date and time, in GPST or UTC; positions as degrees, as degrees, minutes and
// seconds, or as ECEF.
namespace versine::io {

namespace {
using sensors::FixType;
using sensors::GnssSample;

enum class Place { degrees, dms, ecef };

struct Layout {
  bool utc = false;
  Place place = Place::degrees;
  std::size_t columns = 0;  ///< words of the header, without the time
};

// "%  GPST   latitude(deg) ..."; other comment lines say nothing about the columns.
std::optional<Layout> layout_of(std::string_view line) {
  if (line.find("Q ") == line.npos || line.find("ns") == line.npos) return std::nullopt;
  Layout layout;
  layout.utc = line.find("UTC") != line.npos;
  if (line.find("latitude(d'") != line.npos) layout.place = Place::dms;
  if (line.find("x-ecef") != line.npos) layout.place = Place::ecef;
  if (line.find("e-baseline") != line.npos) return std::nullopt;
  return layout;
}

struct Fields {
  std::array<std::string_view, 40> field;
  std::size_t count = 0;
  explicit Fields(std::string_view line) {
    while (count < field.size()) {
      const std::size_t at = line.find_first_not_of(" \t,;");
      if (at == line.npos) break;
      line.remove_prefix(at);
      const std::size_t n = std::min(line.find_first_of(" \t,;"), line.size());
      field[count++] = line.substr(0, n);
      line.remove_prefix(n);
    }
  }
};

/// Numbers of a line behind its time.
struct Row {
  std::array<double, 40> x{};
  std::size_t count = 0;
  std::optional<std::string_view> bad;
};

Row numbers(const Fields& fields, std::size_t from) {
  Row row;
  for (std::size_t i = from; i < fields.count; ++i) {
    const auto x = number(fields.field[i]);
    if (!x) {
      row.bad = fields.field[i];
      break;
    }
    row.x[row.count++] = *x;
  }
  return row;
}

double dms(double d, double m, double s, std::string_view written) {
  const double size = std::abs(d) + m / 60.0 + s / 3600.0;
  return written.starts_with("-") ? -size : size;
}

std::optional<Time> time_of(const Fields& fields, bool utc) {
  if (fields.count < 2) return std::nullopt;
  if (fields.field[0].find('/') != std::string_view::npos) {
    const auto date = parse_date(fields.field[0]);
    const auto time = parse_time_of_day(fields.field[1]);
    if (!date || !time) return std::nullopt;
    const Time since_1970 = *date + *time;
    return utc ? gps_from_utc(since_1970) : since_1970 - gps_epoch_in_utc;
  }
  std::string_view seconds = fields.field[1];
  const auto week = number(fields.field[0]);
  const auto in_week = parse_decimal(seconds, 9);
  if (!week || !(*week >= 0.0 && *week < 10000.0) || !in_week || !seconds.empty()) return std::nullopt;
  return gps_time(static_cast<int>(*week), {*in_week});
}

FixType fix_of(int q) {
  constexpr std::array fixes{FixType::none,         FixType::fixed,  FixType::float_ambiguity, FixType::differential,
                             FixType::differential, FixType::single, FixType::single,          FixType::dead_reckoned};
  return q >= 0 && q < 8 ? fixes[static_cast<std::size_t>(q)] : FixType::none;
}

// Sigmas of x, y, z and the covariances xy, yz, zx, as RTKLIB signs them, to north, east, down.
Eigen::Vector3d ecef_sigma(const double* s, const geodesy::Geodetic& g) {
  const auto signed_square = [](double x) { return x < 0.0 ? -x * x : x * x; };
  Eigen::Matrix3d P;
  P << s[0] * s[0], signed_square(s[3]), signed_square(s[5]), signed_square(s[3]), s[1] * s[1], signed_square(s[4]),
      signed_square(s[5]), signed_square(s[4]), s[2] * s[2];
  const Eigen::Matrix3d C = geodesy::rotation_en(g.latitude, g.longitude);
  return (C.transpose() * P * C).diagonal().cwiseMax(0.0).cwiseSqrt();
}

// From the numbers of one line, of which the place takes the first `n`.
void fill(GnssSample& sample, const Row& row, std::size_t n, Place place) {
  sample.fix = fix_of(static_cast<int>(row.x[n]));
  sample.satellites = static_cast<int>(row.x[n + 1]);
  const double* s = &row.x[n + 2];
  sample.sigma_ned = place == Place::ecef ? ecef_sigma(s, sample.position) : Eigen::Vector3d(s[0], s[1], s[2]);
  if (row.count > n + 9) sample.ratio = static_cast<float>(row.x[n + 9]);
  if (row.count < n + 16) return;
  const double* v = &row.x[n + 10];
  if (place == Place::ecef) {
    const Eigen::Matrix3d C = geodesy::rotation_en(sample.position.latitude, sample.position.longitude);
    sample.v_ned = C.transpose() * Eigen::Vector3d(v[0], v[1], v[2]);
    const double covariances[6] = {v[3],
                                   v[4],
                                   v[5],
                                   row.count > n + 16 ? v[6] : 0.0,
                                   row.count > n + 17 ? v[7] : 0.0,
                                   row.count > n + 18 ? v[8] : 0.0};
    sample.sigma_v_ned = ecef_sigma(covariances, sample.position);
  } else {
    sample.v_ned = Eigen::Vector3d(v[0], v[1], -v[2]);
    sample.sigma_v_ned = Eigen::Vector3d(v[3], v[4], v[5]);
  }
  if (!(sample.sigma_v_ned.minCoeff() > 0.0)) sample.v_ned.reset(), sample.sigma_v_ned.setZero();
}
}  // namespace

Expected<Read<Series<GnssSample>>> read_rtklib(LineReader lines, const GnssFile& file) {
  Read<Series<GnssSample>> read;
  FaultLog faults;
  ClockCorrection correction(file.table.clock);
  std::optional<Layout> layout;
  std::string_view line;
  const auto wrong = [&](std::string found, std::string expected, std::string advice) {
    return fail({.file = lines.name(),
                 .line = lines.line_number(),
                 .found = std::move(found),
                 .expected = std::move(expected),
                 .advice = std::move(advice)});
  };
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t") == line.npos) continue;
    if (line.starts_with("%")) {
      if (line.find("e-baseline") != line.npos) {
        return wrong("baselines", "positions", "solve again with out-solformat = llh");
      }
      if (auto found = layout_of(line)) layout = found;
      continue;
    }
    if (!layout)
      return wrong("data before the header", "RTKLIB's line '%  GPST  latitude(deg) ...'",
                   "solve with out-outhead = on");
    const Fields fields(line);
    const auto time = time_of(fields, layout->utc);
    if (!time)
      return wrong(fmt::format("'{}'", line.substr(0, 30)), "a time in GPST or UTC", "correct or delete the line");
    const Row row = numbers(fields, 2);
    if (row.bad) return wrong(fmt::format("'{}'", *row.bad), "a number", "correct or delete the line");
    const std::size_t place_fields = layout->place == Place::dms ? 7 : 3;
    if (row.count < place_fields + 8) {
      faults.add("line cut short", lines.line_number(), "");
      continue;
    }
    GnssSample sample{.time = correction(*time)};
    const auto& x = row.x;
    if (layout->place == Place::ecef) {
      sample.position = geodesy::wgs84.to_geodetic({{x[0], x[1], x[2]}});
    } else if (layout->place == Place::dms) {
      sample.position = {dms(x[0], x[1], x[2], fields.field[2]) * units::deg,
                         dms(x[3], x[4], x[5], fields.field[5]) * units::deg, x[6]};
    } else {
      sample.position = {x[0] * units::deg, x[1] * units::deg, x[2]};
    }
    if (!(std::abs(sample.position.latitude) <= 90.0 * units::deg &&
          std::abs(sample.position.longitude) <= 360.0 * units::deg)) {
      return wrong(fmt::format("latitude {} and longitude {}", x[0], x[1]), "a place on Earth",
                   "check whether the columns were swapped");
    }
    fill(sample, row, place_fields, layout->place);
    if (sample.fix == FixType::none || !sample.sigma_ned.allFinite() || !std::isfinite(sample.position.height)) {
      faults.add(sample.fix == FixType::none ? "no fix" : "not a number", lines.line_number(), "");
      continue;
    }
    // RTKLIB prints tenths of a millimetre: a single 0.0000 is a small sigma rounded, three of them are none at all.
    if (sample.sigma_ned.minCoeff() >= 0.0 && sample.sigma_ned.maxCoeff() > 0.0) {
      sample.sigma_ned = sample.sigma_ned.cwiseMax(0.5e-4);
    }
    if (sample.sigma_ned.isZero(0.0)) {
      // A fixed position's variance is a small difference of large numbers: now and then nothing is left of it.
      faults.add("no standard deviation", lines.line_number(), "");
      continue;
    }
    if (!(sample.sigma_ned.minCoeff() > 0.0)) {
      return wrong(fmt::format("a standard deviation of {}", sample.sigma_ned.minCoeff()), "positive sdn, sde and sdu",
                   "delete the line, or solve again with RTKLIB's standard deviations");
    }
    faults.now(sample.time);
    read.series.samples.push_back(sample);
  }
  if (lines.error()) return fail(*lines.error());
  if (read.series.empty()) {
    if (const auto fine = faults.tolerable(lines.name(), 0); !fine) return tl::unexpected(fine.error());
  }
  faults.report("gnss", read.record);
  read.series.scale = TimeScale::gps;
  return read;
}

}  // namespace versine::io
