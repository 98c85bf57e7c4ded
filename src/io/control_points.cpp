// SPDX-License-Identifier: Apache-2.0
#include "versine/io/control_points.hpp"

#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>

#include "field_text.hpp"
#include "position_columns.hpp"
#include "text_output.hpp"
#include "versine/core/units.hpp"
#include "versine/io/table_reader.hpp"
#include "versine/io/total_station_formats.hpp"

namespace versine::io {
namespace {

Expected<std::vector<ControlEntry>> from_csv(std::string text, const ControlFile& file) {
  auto opened = TableReader::open(LineReader::from_text(std::move(text), file.table.path.string()), file.table);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  const auto name = table.find_text("name");
  if (!name) {
    return fail({.file = table.name(),
                 .line = table.line_number(),
                 .field = "name",
                 .found = "no such column",
                 .expected = "the number of each control point",
                 .advice = "map the column in [columns]"});
  }
  const auto place = PositionColumns::bind(table, file.frame);
  if (!place) return tl::unexpected(place.error());
  std::array<std::optional<TableReader::Slot>, 3> sigma;
  for (const auto& [i, base] : {std::pair{0, "sigma_north"}, {1, "sigma_east"}, {2, "sigma_up"}}) {
    const auto slot = table.find(base, Quantity::length);
    if (!slot) return tl::unexpected(slot.error());
    sigma[static_cast<std::size_t>(i)] = *slot;
  }
  std::vector<ControlEntry> list;
  while (table.next()) {
    ControlEntry e{.name = std::string(trimmed(table.text(*name))), .line = table.line_number()};
    const auto position = place->read(table);
    if (!position) return tl::unexpected(position.error());
    if (e.name.empty() || !*position) {
      return fail(table.complaint(*name, e.name.empty() ? "no name" : "no coordinates", "a name and three coordinates",
                                  "complete the line, or remove it"));
    }
    e.position = **position;
    for (std::size_t i = 0; i < 3; ++i) {
      const double given = sigma[i] ? table.number(*sigma[i]) : NAN;
      e.sigma_ned(static_cast<Eigen::Index>(i)) = std::isnan(given) ? file.sigma : given;
      if (given < 0.0) {
        return fail(table.complaint(*sigma[i], fmt::format("{}", given), "a standard deviation of zero or more",
                                    "correct the line"));
      }
    }
    list.push_back(std::move(e));
  }
  if (table.error()) return fail(*table.error());
  if (auto fine = table.faults().tolerable(table.name(), list.size()); !fine) return tl::unexpected(fine.error());
  return list;
}

Expected<std::vector<CoordinateEntry>> from_landxml(const std::string& text, const std::string& name) {
  pugi::xml_document document;
  const auto parsed = document.load_string(text.c_str());
  const auto bad = [&](std::string found, std::string advice) {
    return fail({.file = name,
                 .field = "CgPoints",
                 .found = std::move(found),
                 .expected = "LandXML with <CgPoint name=\"...\">northing easting height</CgPoint>",
                 .advice = std::move(advice)});
  };
  if (!parsed) return bad(parsed.description(), "export the points again");
  std::vector<CoordinateEntry> list;
  std::optional<std::string> wrong;
  const double metres = document.select_node("//Units/Imperial") ? 0.3048 : 1.0;
  for (const auto& found : document.select_nodes("//CgPoint")) {
    const auto node = found.node();
    double x[3] = {0.0, 0.0, NAN};
    int n = 0;
    std::string_view content = trimmed(node.text().get());
    while (!content.empty() && n < 3) {
      const auto end = std::min(content.find_first_of(" \t\r\n"), content.size());
      const auto value = to_number(content.substr(0, end));
      if (!value) wrong = node.attribute("name").value();
      x[n++] = metres * value.value_or(NAN);
      content = trimmed(content.substr(end));
    }
    if (node.attribute("pntRef")) continue;
    if (n < 3) wrong = node.attribute("name").value();
    list.push_back({node.attribute("name").value(), {x[1], x[0], x[2]}, 0});
  }
  if (wrong) return bad(fmt::format("point '{}' without three numbers", *wrong), "complete this point's coordinates");
  if (list.empty()) return bad("no CgPoint", "export the control points as CgPoints, or as CSV");
  return list;
}

Expected<std::vector<ControlEntry>> from_map(const std::vector<CoordinateEntry>& points, const ControlFile& file) {
  if (file.frame.crs.empty()) {
    return fail({.file = file.table.path.string(),
                 .field = "crs",
                 .found = "map coordinates, and no coordinate system told",
                 .expected = "the map projection of the control points",
                 .advice = "set crs = \"EPSG:...\" in the job"});
  }
  const auto projection = geodesy::Projection::create(file.frame.crs);
  if (!projection) return tl::unexpected(projection.error());
  std::vector<ControlEntry> list;
  for (const CoordinateEntry& p : points) {
    const auto place = projection->inverse(p.map);
    if (!std::isfinite(place.latitude) || !std::isfinite(place.height)) {
      return fail({.file = file.table.path.string(),
                   .line = p.line,
                   .field = fmt::format("control point {}", p.name),
                   .found = fmt::format("easting {:.3f}, northing {:.3f}, height {:.3f}", p.map.easting, p.map.northing,
                                        p.map.height),
                   .expected = "three coordinates inside " + file.frame.crs,
                   .advice = "were easting and northing exchanged? Is a height missing?"});
    }
    list.push_back({p.name, place, Eigen::Vector3d::Constant(file.sigma), p.line});
  }
  return list;
}

}  // namespace

Expected<std::vector<ControlEntry>> read_control_points(const ControlFile& file) {
  auto text = read_text(file.table.path);
  if (!text) return tl::unexpected(text.error());
  const std::string_view start = trimmed(std::string_view(*text).substr(0, 400));
  const std::string name = file.table.path.string();
  if (start.starts_with('<') || start.starts_with("\xEF\xBB\xBF<")) {
    const auto points = from_landxml(*text, name);
    if (!points) return tl::unexpected(points.error());
    return from_map(*points, file);
  }
  if (auto book = parse_field_book(*text, name); book && !book->coordinates.empty()) {
    return from_map(book->coordinates, file);
  }
  return from_csv(std::move(*text), file);
}

Expected<void> write_control_points(const std::filesystem::path& path, std::span<const ControlEntry> points) {
  TextOutput out(path);
  out.text("name,latitude_deg,longitude_deg,height_m,sigma_north_mm,sigma_east_mm,sigma_up_mm\n");
  for (const ControlEntry& p : points) {
    out.print("{},{:.12f},{:.12f},{:.6f},{:.3f},{:.3f},{:.3f}\n", p.name, p.position.latitude / units::deg,
              p.position.longitude / units::deg, p.position.height, p.sigma_ned.x() * 1e3, p.sigma_ned.y() * 1e3,
              p.sigma_ned.z() * 1e3);
  }
  return out.close();
}

}  // namespace versine::io
