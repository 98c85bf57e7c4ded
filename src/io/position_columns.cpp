// SPDX-License-Identifier: Apache-2.0
#include "position_columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "versine/core/units.hpp"

namespace versine::io {

Expected<PositionColumns> PositionColumns::bind(TableReader& table, const PositionFrame& frame) {
  PositionColumns columns;
  std::array<const char*, 3> names{"latitude", "longitude", "height"};
  Quantity level = Quantity::angle;
  if (!table.has("latitude") && table.has("ecef_x")) {
    columns.form_ = Form::ecef;
    names = {"ecef_x", "ecef_y", "ecef_z"};
    level = Quantity::length;
  } else if (!table.has("latitude") && table.has("easting")) {
    columns.form_ = Form::map;
    names = {"easting", "northing", "height"};
    level = Quantity::length;
    if (frame.crs.empty()) {
      return fail({.file = table.name(),
                   .field = "crs",
                   .found = "easting and northing and no map projection",
                   .expected = "the projection they are in",
                   .advice = "set crs = \"EPSG:25832\" or the like beside the file"});
    }
    auto projection = geodesy::Projection::create(frame.crs);
    if (!projection) return tl::unexpected(projection.error());
    columns.projection_ = std::move(*projection);
  } else if (!table.has("latitude") && table.has("north")) {
    columns.form_ = Form::local;
    columns.up_ = table.has("up");
    names = {"north", "east", columns.up_ ? "up" : "down"};
    level = Quantity::length;
    if (!frame.origin) {
      return fail({.file = table.name(),
                   .field = "origin",
                   .found = "north, east and down and no origin",
                   .expected = "the latitude, longitude and height they count from",
                   .advice = "set the origin beside the file; any place within 1 degree of latitude will do when only "
                             "local results matter"});
    }
    columns.local_.emplace(*frame.origin);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto slot = table.need(names[i], i < 2 ? level : Quantity::length);
    if (!slot) return tl::unexpected(slot.error());
    columns.slot_[i] = *slot;
  }
  return columns;
}

Expected<std::optional<geodesy::Geodetic>> PositionColumns::read(const TableReader& table) const {
  const Eigen::Vector3d x(table.number(slot_[0]), table.number(slot_[1]), table.number(slot_[2]));
  if (!x.allFinite()) return std::optional<geodesy::Geodetic>();
  if (form_ == Form::ecef) return std::optional(geodesy::wgs84.to_geodetic({x}));
  if (form_ == Form::local) return std::optional(local_->to_geodetic({x.x(), x.y(), up_ ? -x.z() : x.z()}));
  if (form_ == Form::map) {
    const geodesy::Geodetic g = projection_->inverse({x.x(), x.y(), x.z()});
    if (std::isfinite(g.latitude) && std::isfinite(g.longitude)) return std::optional(g);
    return fail(table.complaint(slot_[0], fmt::format("easting {} and northing {}", x.x(), x.y()),
                                "coordinates of " + projection_->definition(),
                                "check crs, and whether easting and northing are swapped"));
  }
  constexpr double half_pi = std::numbers::pi / 2.0;
  if (!(std::abs(x.x()) <= half_pi)) {
    const bool swapped = std::abs(x.y()) <= half_pi;
    return fail(table.complaint(slot_[0], fmt::format("{:.7g} deg", x.x() / units::deg), "a latitude within 90 deg",
                                swapped ? "latitude and longitude look swapped: correct [columns]"
                                        : "degrees look like they were declared as radians: correct the unit"));
  }
  if (!(std::abs(x.y()) <= 4.0 * half_pi)) {
    return fail(table.complaint(slot_[1], fmt::format("{:.7g} deg", x.y() / units::deg), "a longitude within 360 deg",
                                "degrees look like they were declared as radians: correct the unit"));
  }
  const double longitude = std::remainder(x.y(), 4.0 * half_pi);
  return std::optional(geodesy::Geodetic{x.x(), longitude, x.z()});
}

Expected<SigmaColumns> SigmaColumns::bind(TableReader& table, const std::string& prefix, Quantity quantity,
                                          const Given& given) {
  SigmaColumns columns;
  const std::array<std::array<const char*, 3>, 3> names{
      {{"north", "horizontal", "hdop"}, {"east", "horizontal", "hdop"}, {"down", "vertical", "vdop"}}};
  for (std::size_t i = 0; i < 3; ++i) {
    auto slot = table.find(prefix + names[i][0], quantity);
    if (slot && !*slot && i == 2) slot = table.find(prefix + "up", quantity);
    if (slot && !*slot) slot = table.find(prefix + names[i][1], quantity);
    if (!slot) return tl::unexpected(slot.error());
    const auto& constant = i < 2 ? given.horizontal : given.vertical;
    if (!*slot && !constant && given.range && table.has(names[i][2])) {
      slot = table.find(names[i][2], Quantity::none);
      // HDOP is the root of the sum of both horizontal components.
      columns.factor_[i] = *given.range * (i < 2 ? std::sqrt(0.5) : 1.0);
    }
    columns.slot_[i] = *slot;
    if (*slot) continue;
    if (!constant || !(*constant > 0.0)) {
      return fail({.file = table.name(),
                   .field = prefix + names[i][0],
                   .found = constant ? fmt::format("a sigma of {}", *constant) : "no standard deviation",
                   .expected = "a column " + prefix + names[i][0] + "_m, or a positive sigma for the whole file",
                   .advice = "set sigma_horizontal_m and sigma_vertical_m beside the file"});
    }
    columns.constant_[i] = *constant;
  }
  return columns;
}

Expected<Eigen::Vector3d> SigmaColumns::read(const TableReader& table) const {
  Eigen::Vector3d sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[static_cast<Eigen::Index>(i)] = slot_[i] ? factor_[i] * table.number(*slot_[i]) : constant_[i];
    if (slot_[i] && sigma[static_cast<Eigen::Index>(i)] <= 0.0) {
      return fail(table.complaint(*slot_[i], fmt::format("{}", sigma[static_cast<Eigen::Index>(i)]),
                                  "a positive standard deviation",
                                  "give the real one, or leave the column out and set sigma_horizontal_m and "
                                  "sigma_vertical_m for the whole file"));
    }
  }
  return sigma;
}

}  // namespace versine::io
