// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "versine/geodesy/local_frame.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {

/// The columns of a table that make a position: latitude, longitude, height; ecef_x, ecef_y, ecef_z; north, east,
/// down (or up) about an origin; or easting, northing, height in a map.
class PositionColumns {
 public:
  [[nodiscard]] static Expected<PositionColumns> bind(TableReader& table, const PositionFrame& frame);
  /// Of the present row; nothing when a field is empty. Latitudes and longitudes that are none are Errors.
  [[nodiscard]] Expected<std::optional<geodesy::Geodetic>> read(const TableReader& table) const;

 private:
  enum class Form { geodetic, ecef, local, map };
  Form form_ = Form::geodetic;
  std::array<TableReader::Slot, 3> slot_{};
  bool up_ = false;
  std::optional<geodesy::LocalFrame> local_;
  std::optional<geodesy::Projection> projection_;
};

/// Sigmas of north, east, down: from columns, from dilutions of precision, or given.
class SigmaColumns {
 public:
  struct Given {
    std::optional<double> horizontal, vertical, range;
  };
  /// `prefix` is "sigma_" or "sigma_velocity_".
  [[nodiscard]] static Expected<SigmaColumns> bind(TableReader& table, const std::string& prefix, Quantity quantity,
                                                   const Given& given);
  /// NaN where the field is empty; an Error where a sigma is zero or negative.
  [[nodiscard]] Expected<Eigen::Vector3d> read(const TableReader& table) const;

 private:
  std::array<std::optional<TableReader::Slot>, 3> slot_;
  std::array<double, 3> constant_{};
  std::array<double, 3> factor_{1.0, 1.0, 1.0};
};

}  // namespace versine::io
