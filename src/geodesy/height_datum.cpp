// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/height_datum.hpp"

#include <fmt/format.h>
#include <proj.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace versine::geodesy {

struct HeightDatum::Grid {
  PJ_CONTEXT* context = proj_context_create();
  PJ* shift = nullptr;
  Grid() { proj_log_level(context, PJ_LOG_NONE); }
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;
  ~Grid() {
    if (shift != nullptr) proj_destroy(shift);
    proj_context_destroy(context);
  }
};

namespace {

Expected<void> check(const std::vector<HeightPoint>& points, std::size_t needed) {
  for (const HeightPoint& p : points) {
    if (std::isfinite(p.measured) && std::isfinite(p.wanted) && std::isfinite(p.easting) && std::isfinite(p.northing) &&
        p.sigma > 0.0) {
      continue;
    }
    return fail({.field = "height point " + p.name,
                 .found = "a number that is not finite, or no positive sigma",
                 .expected = "heights and coordinates in metres"});
  }
  if (points.size() >= needed) return {};
  return fail({.field = "height points",
               .found = fmt::format("{}", points.size()),
               .expected = fmt::format("at least {}", needed),
               .advice = needed == 3 ? "add points, or use an offset" : "name a point with a known height"});
}

}  // namespace

Expected<HeightDatum> HeightDatum::fit(const std::vector<HeightPoint>& points, Kind kind) {
  const bool plane = kind == Kind::plane;
  if (auto good = check(points, plane ? 3 : 1); !good) return tl::unexpected(good.error());
  HeightDatum d;
  d.kind_ = kind;
  double weights = 0.0;
  for (const HeightPoint& p : points) {
    const double w = 1.0 / (p.sigma * p.sigma);
    weights += w;
    d.east_ += w * p.easting;
    d.north_ += w * p.northing;
  }
  d.east_ /= weights;
  d.north_ /= weights;
  const auto row = [&](const HeightPoint& p) -> Eigen::Vector3d {
    return plane ? Eigen::Vector3d(1.0, p.easting - d.east_, p.northing - d.north_) : Eigen::Vector3d(1.0, 0.0, 0.0);
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const HeightPoint& p : points) {
    const double w = 1.0 / (p.sigma * p.sigma);
    normal += w * row(p) * row(p).transpose();
    right += w * row(p) * (p.wanted - p.measured);
  }
  if (plane) {  // a plane needs breadth: the smaller eigenvalue of the spread
    const double a = normal(1, 1), b = normal(2, 2), c = normal(1, 2);
    const double mean = 0.5 * (a + b), half = std::hypot(0.5 * (a - b), c);
    if (!(mean - half > 1e-6 * (mean + half))) {
      return fail({.field = "height points",
                   .found = "points in one line",
                   .expected = "three points not in a line",
                   .advice = "add a point beside the line, or use an offset"});
    }
  } else {
    normal(1, 1) = normal(2, 2) = 1.0;
  }
  const Eigen::Matrix3d q = normal.inverse();
  const Eigen::Vector3d x = q * right;
  d.offset_ = x[0];
  d.slope_east_ = x[1];
  d.slope_north_ = x[2];
  d.sigma_ = std::sqrt(q(0, 0));
  double sum = 0.0;
  for (const HeightPoint& p : points) {
    const double r = p.wanted - p.measured - row(p).dot(x);
    const double variance = p.sigma * p.sigma - row(p).dot(q * row(p));
    d.residuals_.push_back(r);
    sum += r * r / (p.sigma * p.sigma);
    if (variance > 1e-9 * p.sigma * p.sigma && std::abs(r) > 3.29 * std::sqrt(variance)) d.outlying_.push_back(p.name);
  }
  const auto redundancy = static_cast<double>(points.size()) - (plane ? 3.0 : 1.0);
  d.sigma0_ = redundancy > 0.0 ? std::sqrt(sum / redundancy) : std::numeric_limits<double>::quiet_NaN();
  return d;
}

Expected<HeightDatum> HeightDatum::offset(const std::vector<HeightPoint>& points) {
  return fit(points, Kind::offset);
}
Expected<HeightDatum> HeightDatum::plane(const std::vector<HeightPoint>& points) {
  return fit(points, Kind::plane);
}

Expected<HeightDatum> HeightDatum::geoid(const std::string& grid) {
  auto made = std::make_shared<Grid>();
  const std::string pipeline = "+proj=vgridshift +grids=" + grid + " +multiplier=1";
  made->shift = proj_create(made->context, pipeline.c_str());
  if (made->shift == nullptr || grid.empty()) {
    return fail({.field = "geoid",
                 .found = fmt::format("'{}' ({})", grid,
                                      proj_context_errno_string(made->context, proj_context_errno(made->context))),
                 .expected = "a geoid grid that PROJ finds",
                 .advice = "put the grid into PROJ's data folder (PROJ_DATA), or give its whole path"});
  }
  HeightDatum d;
  d.kind_ = Kind::geoid;
  d.sigma0_ = std::numeric_limits<double>::quiet_NaN();
  d.sigma_ = std::numeric_limits<double>::quiet_NaN();
  d.grid_ = std::move(made);
  d.grid_name_ = grid;
  return d;
}

double HeightDatum::apply(const Geodetic& place, const MapPoint& map) const {
  if (kind_ == Kind::geoid) {
    const PJ_COORD out =
        proj_trans(grid_->shift, PJ_INV, proj_coord(place.longitude, place.latitude, place.height, 0.0));
    return std::isfinite(out.lpz.z) ? out.lpz.z : std::numeric_limits<double>::quiet_NaN();
  }
  return map.height + offset_ + slope_east_ * (map.easting - east_) + slope_north_ * (map.northing - north_);
}

std::string HeightDatum::description() const {
  switch (kind_) {
    case Kind::none:
      return "heights as in the trajectory";
    case Kind::offset:
      return fmt::format("offset {:+.4f} m from {} point(s)", offset_, residuals_.size());
    case Kind::plane:
      return fmt::format("tilted plane from {} points: {:+.4f} m, {:+.2f} mm/km east, {:+.2f} mm/km north",
                         residuals_.size(), offset_, slope_east_ * 1e6, slope_north_ * 1e6);
    case Kind::geoid:
      return "heights above the geoid grid " + grid_name_;
  }
  return "";
}

}  // namespace versine::geodesy
