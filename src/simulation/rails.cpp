// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/rails.hpp"

#include <algorithm>
#include <cmath>

#include "versine/geodesy/projection.hpp"

namespace versine::simulation {

namespace {
/// Value of a table at a distance; zero outside.
double look_up(const Deviations& table, const std::vector<double>& column, double distance) {
  const double t = (distance - table.begin) / table.step;
  if (!(t >= 0.0) || column.empty() || t > static_cast<double>(column.size() - 1)) return 0.0;
  const auto i = std::min(static_cast<std::size_t>(t), column.size() - 1);
  const double u = t - static_cast<double>(i);
  return i + 1 < column.size() ? (1.0 - u) * column[i] + u * column[i + 1] : column[i];
}

/// Cross-section of the track: axis point in the map, direction, and how it leans.
struct Section {
  double easting, northing, height;
  double heading, lean, half_gauge;
};

Section section(const TrackModel& track, const Deviations& d, std::size_t i, double distance) {
  const design::DesignPoint p = track.alignment.at(distance);
  const double cant = std::isnan(p.cant) ? 0.0 : p.cant;
  const double half_base = 0.5 * design::cant_base;
  const double rise = track.cant_pivot == TrackModel::CantPivot::low_rail ? 0.5 * std::abs(cant) : 0.0;
  const double lean = std::asin(std::clamp((cant + d.cross_level[i]) / (2.0 * half_base), -0.5, 0.5));
  const double height = std::isnan(p.height) ? track.height : p.height;
  return {p.easting + d.alignment[i] * std::cos(p.heading),  // to the right: east of north
          p.northing - d.alignment[i] * std::sin(p.heading),
          height + rise + d.level[i],
          p.heading,
          lean,
          0.5 * (track.gauge + d.gauge[i])};
}

/// Angle from true north to grid north, clockwise, from two places on one grid line: 1e-9 rad. (PROJ's own factors
/// cost milliseconds for each place of a projected CRS.)
double convergence_at(const geodesy::Projection& projection, const Section& s) {
  const geodesy::Geodetic south = projection.inverse({s.easting, s.northing - 50.0, s.height});
  const geodesy::Geodetic north = projection.inverse({s.easting, s.northing + 50.0, s.height});
  const geodesy::Geodetic middle = projection.inverse({s.easting, s.northing, s.height});
  const Eigen::Vector3d along =
      geodesy::wgs84.ned_difference(middle, north) - geodesy::wgs84.ned_difference(middle, south);
  return std::atan2(along.y(), along.x());
}
}  // namespace

Deviations deviations(const TrackModel& track, double begin, double step, std::size_t count) {
  const auto draw = [&](Irregularity kind) {
    auto x = synthesize(track.spectrum, kind, step, count, track.shortest, track.longest, track.seed);
    for (double& v : x) v *= track.spectrum_factor;
    return x;
  };
  Deviations d{begin,
               step,
               draw(Irregularity::level),
               draw(Irregularity::alignment),
               draw(Irregularity::cross_level),
               draw(Irregularity::gauge)};
  for (const Defect& defect : track.defects) {
    const double half = 0.5 * std::max(defect.length, defect.extent);
    const double first = std::ceil((defect.distance - half - begin) / step);
    const double last = std::floor((defect.distance + half - begin) / step);
    for (double k = std::max(0.0, first); k <= std::min(last, static_cast<double>(count) - 1.0); k += 1.0) {
      const Deviation add = deviation_of(defect, begin + k * step);
      const auto i = static_cast<std::size_t>(k);
      d.level[i] += add.level, d.alignment[i] += add.alignment;
      d.cross_level[i] += add.cross_level, d.gauge[i] += add.gauge;
    }
  }
  if (track.table) {
    for (std::size_t i = 0; i < count; ++i) {
      const double s = begin + static_cast<double>(i) * step;
      d.level[i] += look_up(*track.table, track.table->level, s);
      d.alignment[i] += look_up(*track.table, track.table->alignment, s);
      d.cross_level[i] += look_up(*track.table, track.table->cross_level, s);
      d.gauge[i] += look_up(*track.table, track.table->gauge, s);
    }
  }
  return d;
}

Expected<Rails> build_rails(const TrackModel& track) {
  auto projection = geodesy::Projection::create(track.alignment.crs);
  if (!projection) return tl::unexpected(std::move(projection.error()));
  // Beyond both ends the axis goes on straight: room for a body that stands at an end, and for the spline's margin.
  const double room = 30.0;
  const auto extra = static_cast<std::size_t>(std::ceil(room / track.grid)) + UniformSpline<6>::margin;
  const double begin = -static_cast<double>(extra) * track.grid;
  const auto count = static_cast<std::size_t>(std::ceil(track.alignment.length() / track.grid)) + 2 * extra + 1;
  const Deviations d = deviations(track, begin, track.grid, count);

  const auto geodetic = [&](const Section& s) { return projection->inverse({s.easting, s.northing, s.height}); };
  const geodesy::Geodetic origin = geodetic(section(track, d, count / 2, 0.5 * track.alignment.length()));
  if (!std::isfinite(origin.latitude) || !std::isfinite(origin.longitude)) {
    return fail({.field = "track.crs",
                 .found = "the alignment lies where the projection is not defined",
                 .expected = "map coordinates inside its area",
                 .advice = "check easting and northing of the start, or name the map that they belong to"});
  }
  Rails rails{geodesy::LocalFrame(origin), {}, track.grid, 0.0, track.alignment.length()};
  UniformSpline<6>::Samples samples(6, static_cast<Eigen::Index>(count));
  // Convergence bends by less than 1e-9 rad over this many points: computed now and then, interpolated between.
  constexpr std::size_t every = 64;
  double convergence = 0.0, next = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Section s = section(track, d, i, begin + static_cast<double>(i) * track.grid);
    const geodesy::Geodetic axis = geodetic(s);
    if (i % every == 0) {
      const std::size_t j = std::min(i + every, count - 1);
      convergence = i == 0 ? convergence_at(*projection, s) : next;
      next = convergence_at(*projection, section(track, d, j, begin + static_cast<double>(j) * track.grid));
    }
    const double azimuth =
        s.heading + convergence + (next - convergence) * static_cast<double>(i % every) / static_cast<double>(every);
    // Right of the axis, leaning: positive cant lifts the left rail, so the right hand points down.
    const Eigen::Vector3d across(-std::sin(azimuth) * std::cos(s.lean), std::cos(azimuth) * std::cos(s.lean),
                                 std::sin(s.lean));
    const Eigen::Vector3d arm = s.half_gauge * (rails.frame.rotation_from(axis) * across);
    const Eigen::Vector3d centre = rails.frame.to_ned(axis);
    samples.col(static_cast<Eigen::Index>(i)) << centre - arm, centre + arm;
  }
  rails.curve = UniformSpline<6>(begin, track.grid, std::move(samples));
  return rails;
}

}  // namespace versine::simulation
