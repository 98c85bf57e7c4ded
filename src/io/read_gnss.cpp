// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "position_columns.hpp"
#include "read_from.hpp"
#include "table_fields.hpp"
#include "time_columns.hpp"

namespace versine::io {

namespace {
using sensors::FixType;
using sensors::GnssSample;
using Format = GnssFile::Format;

FixType fix_of_rtklib(double q) {
  switch (static_cast<int>(q)) {
    case 1:
      return FixType::fixed;
    case 2:
      return FixType::float_ambiguity;
    case 3:
    case 4:
      return FixType::differential;
    case 5:
    case 6:
      return FixType::single;
    case 7:
      return FixType::dead_reckoned;
    default:
      return FixType::none;
  }
}

FixType fix_of_nmea(double q) {
  switch (static_cast<int>(q)) {
    case 1:
    case 3:
      return FixType::single;
    case 2:
      return FixType::differential;
    case 4:
      return FixType::fixed;
    case 5:
      return FixType::float_ambiguity;
    case 6:
      return FixType::dead_reckoned;
    default:
      return FixType::none;
  }
}

/// Velocity and what a receiver tells besides.
struct Extras {
  std::array<TableReader::Slot, 3> velocity{};
  std::optional<SigmaColumns> velocity_sigma;
  bool up = false;
  std::optional<TableReader::Slot> rtklib, nmea, satellites, ratio;
};

Expected<Extras> bind_extras(TableReader& table, const GnssFile& file) {
  Extras extras;
  if (table.has("velocity_north")) {
    extras.up = table.has("velocity_up");
    const char* names[] = {"velocity_north", "velocity_east", extras.up ? "velocity_up" : "velocity_down"};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto slot = table.need(names[i], Quantity::speed);
      if (!slot) return tl::unexpected(slot.error());
      extras.velocity[i] = *slot;
    }
    const auto sigma = SigmaColumns::bind(table, "sigma_velocity_", Quantity::speed,
                                          {file.sigma_velocity, file.sigma_velocity, std::nullopt});
    if (!sigma) {
      Error error = sigma.error();
      error.advice = "set sigma_velocity_mps beside the file, or map the velocity away in [columns]";
      return fail(error);
    }
    extras.velocity_sigma = *sigma;
  }
  for (const auto& [name, slot] : {std::pair{"fix_rtklib", &extras.rtklib},
                                   {"fix_nmea", &extras.nmea},
                                   {"satellites", &extras.satellites},
                                   {"ratio", &extras.ratio}}) {
    const auto found = table.find(name, Quantity::none);
    if (!found) return tl::unexpected(found.error());
    *slot = *found;
  }
  return extras;
}

Expected<void> read_extras(const Extras& extras, const TableReader& table, GnssSample& sample) {
  if (extras.velocity_sigma) {
    const auto sigma = extras.velocity_sigma->read(table);
    if (!sigma) return tl::unexpected(sigma.error());
    Eigen::Vector3d v(table.number(extras.velocity[0]), table.number(extras.velocity[1]),
                      table.number(extras.velocity[2]));
    if (extras.up) v.z() = -v.z();
    if (v.allFinite() && sigma->allFinite()) sample.v_ned = v, sample.sigma_v_ned = *sigma;
  }
  if (extras.rtklib) sample.fix = fix_of_rtklib(table.number(*extras.rtklib));
  if (extras.nmea) sample.fix = fix_of_nmea(table.number(*extras.nmea));
  if (extras.satellites && table.number(*extras.satellites) < 1000.0) {
    sample.satellites = static_cast<int>(table.number(*extras.satellites));
  }
  if (extras.ratio) sample.ratio = static_cast<float>(table.number(*extras.ratio));
  return {};
}

Expected<Read<Series<GnssSample>>> read_table(LineReader lines, const GnssFile& file) {
  const std::string name = lines.name();
  auto opened = TableReader::open(std::move(lines), file.table);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  auto times = TimeColumns::bind(table, file.table.clock);
  if (!times) return tl::unexpected(times.error());
  const auto place = PositionColumns::bind(table, file.frame);
  if (!place) return tl::unexpected(place.error());
  const auto sigmas = SigmaColumns::bind(table, "sigma_", Quantity::length,
                                         {file.sigma_horizontal, file.sigma_vertical, file.sigma_range});
  if (!sigmas) return tl::unexpected(sigmas.error());
  const auto extras = bind_extras(table, file);
  if (!extras) return tl::unexpected(extras.error());

  Read<Series<GnssSample>> read;
  while (table.next()) {
    const auto time = times->read(table);
    if (!time) return tl::unexpected(time.error());
    if (!*time) {
      table.faults().add("no time", table.line_number(), "");
      continue;
    }
    GnssSample sample{.time = **time};
    if (const auto more = read_extras(*extras, table, sample); !more) return tl::unexpected(more.error());
    if (sample.fix == FixType::none) {
      table.faults().add("no fix", table.line_number(), "");
      continue;
    }
    const auto position = place->read(table);
    if (!position) return tl::unexpected(position.error());
    const auto sigma = sigmas->read(table);
    if (!sigma) return tl::unexpected(sigma.error());
    if (!*position || !sigma->allFinite()) {
      table.faults().add("not a number", table.line_number(), "");
      continue;
    }
    sample.position = **position;
    sample.sigma_ned = *sigma;
    table.faults().now(sample.time);
    read.series.samples.push_back(sample);
  }
  if (table.error()) return fail(*table.error());
  if (read.series.empty()) {
    if (const auto fine = table.faults().tolerable(name, 0); !fine) return tl::unexpected(fine.error());
  }
  table.faults().report("gnss", read.record);
  read.series.scale = times->scale();
  return read;
}

// What a file is, from its first lines.
Expected<Format> recognise(LineReader& lines) {
  std::string_view line;
  if (!lines.next(line)) {
    if (lines.error()) return fail(*lines.error());
    return Format::csv;
  }
  Format format = Format::csv;
  if (line.starts_with("$G") || line.starts_with("!") || line.starts_with("$P")) format = Format::nmea;
  if (line.starts_with("%") &&
      (line.find("GPST") != line.npos || line.find("UTC") != line.npos || line.find("program") != line.npos)) {
    format = Format::rtklib;
  }
  lines.put_back();
  return format;
}

GnssFile with_layout(GnssFile file) {
  if (file.format == Format::kf_gins && file.table.columns.empty()) {
    file.table.columns = {{"tow_s", "1"},         {"latitude_deg", "2"}, {"longitude_deg", "3"}, {"height_m", "4"},
                          {"sigma_north_m", "5"}, {"sigma_east_m", "6"}, {"sigma_down_m", "7"}};
  }
  return file;
}
}  // namespace

Expected<Read<Series<GnssSample>>> read_gnss_from(LineReader lines, const GnssFile& given) {
  GnssFile file = with_layout(given);
  if (file.format == Format::automatic) {
    const auto format = recognise(lines);
    if (!format) return tl::unexpected(format.error());
    file.format = *format;
  }
  if (file.format == Format::rtklib) return read_rtklib(std::move(lines), file);
  if (file.format == Format::nmea) return read_nmea(std::move(lines), file);
  return read_table(std::move(lines), file);
}

Expected<Read<Series<GnssSample>>> read_gnss(const GnssFile& file) {
  auto lines = LineReader::open(file.table.path);
  if (!lines) return tl::unexpected(lines.error());
  return read_gnss_from(std::move(*lines), file);
}

}  // namespace versine::io
