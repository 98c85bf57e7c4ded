// SPDX-License-Identifier: Apache-2.0
#include "versine/io/tra_gra.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "versine/design/axis_index.hpp"

namespace versine::io {

namespace {

using design::Shape;
using Verdict = design::AuditFinding::Verdict;

constexpr std::size_t tra_record = 78, gra_record = 36;

template <class T>
T field(const std::string& bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little, "the file's byte order");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// The file's records, header included, when its size fits.
Expected<std::string> read_records(const std::filesystem::path& path, std::size_t size, const char* kind) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (in && bytes.size() >= 2 * size && bytes.size() % size == 0) return bytes;
  return fail({.file = path.string(),
               .found = in ? fmt::format("{} bytes", bytes.size()) : "no readable file",
               .expected = fmt::format("a DB {} file: a header and records of {} bytes each", kind, size),
               .advice = "the file may be cut short or be of another format"});
}

struct TraRecord {
  double r1, r2, easting, northing, azimuth, station, length, cant1_mm, cant2_mm;
  int kind;
};
TraRecord tra_at(const std::string& b, std::size_t i) {
  const std::size_t o = i * tra_record;
  return {field<double>(b, o),      field<double>(b, o + 8),       field<double>(b, o + 16), field<double>(b, o + 24),
          field<double>(b, o + 32), field<double>(b, o + 40),      field<double>(b, o + 50), field<double>(b, o + 58),
          field<double>(b, o + 66), field<std::int16_t>(b, o + 48)};
}

double curvature(double radius) {
  return radius == 0.0 ? 0.0 : 1.0 / radius;
}

/// kz of the format: 0 line, 1 circle, 2 clothoid, 3 S-form, 4 Bloss, 7 and 8 their single-curved forms.
Expected<Shape> shape_of(const std::filesystem::path& path, std::size_t record, int kind) {
  switch (kind) {
    case 0:
      return Shape::line;
    case 1:
      return Shape::arc;
    case 2:
      return Shape::clothoid;
    case 3:
    case 7:
      return Shape::helmert;
    case 4:
    case 8:
      return Shape::bloss;
    default:
      return fail({.file = path.string(),
                   .line = record,
                   .field = "kz",
                   .found = fmt::format("{}", kind),
                   .expected = "an element kind from 0 to 8",
                   .advice = "the record is none of Verm.esn"});
  }
}

void add_cant(const TraRecord& r, Shape shape, double distance, design::RawAlignment& raw) {
  // The outer rail is the left one of a right-hand curve (positive radius).
  const double side = (r.r1 != 0.0 ? r.r1 : r.r2) < 0.0 ? -1e-3 : 1e-3;
  const Shape ramp = design::is_transition(shape) ? shape : Shape::clothoid;
  raw.cant.push_back({distance, side * r.cant1_mm, ramp});
  raw.cant.push_back({distance + r.length, side * r.cant2_mm, ramp});
}

/// Neighbouring elements state the cant of their joint twice.
void drop_doubles(std::vector<design::CantPoint>& cant) {
  std::vector<design::CantPoint> kept;
  for (const design::CantPoint& p : cant) {
    if (!kept.empty() && kept.back().distance == p.distance && kept.back().cant == p.cant) kept.pop_back();
    kept.push_back(p);
  }
  cant = std::move(kept);
}

}  // namespace

Expected<design::RawAlignment> read_tra(const std::filesystem::path& path) {
  const auto bytes = read_records(path, tra_record, "TRA");
  if (!bytes) return tl::unexpected(bytes.error());
  design::RawAlignment raw;
  raw.file = path.string();
  raw.name = path.stem().string();
  double distance = 0.0;
  bool kink = false;
  const std::size_t count = bytes->size() / tra_record;
  for (std::size_t i = 1; i < count; ++i) {
    const TraRecord r = tra_at(*bytes, i);
    for (const double v : {r.r1, r.r2, r.easting, r.northing, r.azimuth, r.station, r.length, r.cant1_mm, r.cant2_mm}) {
      if (std::isfinite(v) && std::abs(v) < 1e9) continue;
      return fail({.file = raw.file,
                   .line = i,
                   .field = "record",
                   .found = fmt::format("the number {}", v),
                   .expected = "coordinates, radii and lengths in metres",
                   .advice = "the file is damaged"});
    }
    if (i == 1) raw.chainage.push_back({0.0, r.station, true, "start"});
    const std::string where = fmt::format("record {} (kz {})", i, r.kind);
    if (r.kind == 5) kink = true;
    if (r.kind == 6) {  // chainage jump: the next record's station counts on from here
      if (i + 1 < count) raw.chainage.push_back({distance, tra_at(*bytes, i + 1).station, true, where});
      continue;
    }
    // Each record states only its start, which is also the end of the element before.
    if (!raw.elements.empty()) raw.elements.back().end = design::MapPosition{r.easting, r.northing};
    if (r.kind == 5 || r.length == 0.0) continue;
    const auto shape = shape_of(path, i, r.kind);
    if (!shape) return tl::unexpected(shape.error());
    design::RawElement e;
    e.where = where;
    e.kink_intended = std::exchange(kink, false);
    e.start = {r.easting, r.northing};
    e.element = {
        .shape = *shape, .length = r.length, .curvature_start = curvature(r.r1), .curvature_end = curvature(r.r2)};
    if (*shape == Shape::line) e.element.curvature_start = e.element.curvature_end = 0.0;
    raw.elements.push_back(e);
    add_cant(r, *shape, distance, raw);
    distance += r.length;
  }
  drop_doubles(raw.cant);
  return raw;
}

Expected<std::vector<GraPoint>> read_gra(const std::filesystem::path& path) {
  const auto bytes = read_records(path, gra_record, "GRA");
  if (!bytes) return tl::unexpected(bytes.error());
  std::vector<GraPoint> points;
  for (std::size_t i = 1; i < bytes->size() / gra_record; ++i) {
    const std::size_t o = i * gra_record;
    const GraPoint p{field<double>(*bytes, o), field<double>(*bytes, o + 8), std::abs(field<double>(*bytes, o + 16)),
                     field<double>(*bytes, o + 24)};
    if (!std::isfinite(p.mileage) || !std::isfinite(p.height) || !std::isfinite(p.radius)) {
      return fail({.file = path.string(),
                   .line = i,
                   .field = "record",
                   .found = "no finite number",
                   .expected = "mileage, height, radius and tangent in metres",
                   .advice = "the file is damaged"});
    }
    points.push_back(p);
  }
  return points;
}

namespace {

/// Distance along the track of each gradient change, in order.
Expected<std::vector<design::VerticalPoint>> carry(const std::vector<GraPoint>& gra, const design::Alignment& track,
                                                   const design::Alignment& stationing) {
  const design::AxisIndex index(track.horizontal);
  std::vector<design::VerticalPoint> points;
  double last = -1e9;
  for (const GraPoint& g : gra) {
    // The line before its start or behind its end is its tangent; mileage goes on there.
    std::vector<double> at = stationing.chainage.distances(g.mileage, stationing.length());
    std::erase_if(at, [last](double d) { return d < last - 0.01; });
    const auto& equations = stationing.chainage.equations();
    if (at.empty() && g.mileage < equations.front().mileage) at = {g.mileage - equations.front().mileage};
    if (at.empty()) at = {equations.back().distance + g.mileage - equations.back().mileage};
    last = at.front();
    const design::AxisPose p = stationing.horizontal.at(last);
    const design::AxisFoot foot = index.project(p.easting, p.northing);
    using Curve = design::VerticalPoint::Curve;
    if (!points.empty() && foot.distance - points.back().distance < 0.01) continue;  // both sides of a chainage jump
    points.push_back({foot.distance, g.height, g.radius > 0.0 ? Curve::circle : Curve::none, 0.0, g.radius,
                      design::format_mileage(g.mileage)});
  }
  if (points.size() < 2) {
    return fail({.field = "GRA",
                 .found = "gradients at one place of the track",
                 .expected = "gradients along it",
                 .advice = "the GRA file belongs to another line, or the stationing line is missing"});
  }
  return points;
}

}  // namespace

Expected<design::Imported> read_tra_gra(const std::filesystem::path& tra,
                                        const std::optional<std::filesystem::path>& gra,
                                        const std::optional<std::filesystem::path>& stationing,
                                        const design::AuditLimits& limits) {
  auto raw = read_tra(tra);
  if (!raw) return tl::unexpected(raw.error());
  if (!gra) return design::assemble(*raw, limits);
  const auto gradients = read_gra(*gra);
  if (!gradients) return tl::unexpected(gradients.error());
  const design::Imported track = design::assemble(*raw, limits);
  if (!track.alignment) return track;
  design::Imported line = track;
  if (stationing) {
    const auto raw_line = read_tra(*stationing);
    if (!raw_line) return tl::unexpected(raw_line.error());
    line = design::assemble(*raw_line, limits);
    if (!line.alignment) return tl::unexpected(line.alignment.error());
  }
  auto points = carry(*gradients, *track.alignment, *line.alignment);
  if (!points) {
    points.error().file = gra->string();
    return tl::unexpected(points.error());
  }
  raw->profile = *std::move(points);
  return design::assemble(*raw, limits);
}

}  // namespace versine::io
