// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "position_columns.hpp"
#include "time_columns.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::io {

Expected<Read<Series<sensors::LandmarkSample>>> read_landmarks(const LandmarkFile& file) {
  auto lines = LineReader::open(file.table.path);
  if (!lines) return tl::unexpected(lines.error());
  const std::string name = lines->name();
  auto opened = TableReader::open(std::move(*lines), file.table);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  const bool standstill = table.has("time_from");
  auto from = TimeColumns::bind(table, file.table.clock, standstill ? "time_from" : "time");
  if (!from) return tl::unexpected(from.error());
  std::optional<TimeColumns> to;
  if (standstill) {
    auto bound = TimeColumns::bind(table, file.table.clock, "time_to");
    if (!bound) return tl::unexpected(bound.error());
    to = std::move(*bound);
  }
  const auto place = PositionColumns::bind(table, file.frame);
  if (!place) return tl::unexpected(place.error());
  const auto sigmas =
      SigmaColumns::bind(table, "sigma_", Quantity::length, {file.sigma_horizontal, file.sigma_vertical, std::nullopt});
  if (!sigmas) return tl::unexpected(sigmas.error());
  const auto label = table.find_text("name");

  Read<Series<sensors::LandmarkSample>> read;
  while (table.next()) {
    const auto begin = from->read(table);
    if (!begin) return tl::unexpected(begin.error());
    const auto end = to ? to->read(table) : begin;
    if (!end) return tl::unexpected(end.error());
    const auto position = place->read(table);
    if (!position) return tl::unexpected(position.error());
    const auto sigma = sigmas->read(table);
    if (!sigma) return tl::unexpected(sigma.error());
    if (!*begin || !*end || !*position || !sigma->allFinite()) {
      table.faults().add("not a number", table.line_number(), "");
      continue;
    }
    if (**end < **begin) {
      return fail({.file = name,
                   .line = table.line_number(),
                   .field = "time_to",
                   .found = "an end before the beginning",
                   .expected = "time_from before time_to",
                   .advice = "correct the line"});
    }
    sensors::LandmarkSample sample;
    sample.from = **begin;
    sample.to = **end;
    sample.time = sample.from + Duration{(sample.to - sample.from).ns / 2};
    sample.name = label ? std::string(table.text(*label)) : fmt::format("landmark {}", read.series.size() + 1);
    sample.position = **position;
    sample.covariance = sigma->cwiseAbs2().asDiagonal();
    table.faults().now(sample.time);
    read.series.samples.push_back(std::move(sample));
  }
  if (table.error()) return fail(*table.error());
  if (const auto fine = table.faults().tolerable(name, read.series.size()); !fine) return tl::unexpected(fine.error());
  table.faults().report("landmark", read.record);
  read.series.scale = from->scale();
  return read;
}

}  // namespace versine::io
