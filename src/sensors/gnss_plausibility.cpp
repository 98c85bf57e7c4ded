// SPDX-License-Identifier: Apache-2.0
// Positions against the gyroscopes' turn, the receiver's velocities and the odometer's way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/sensors/plausibility.hpp"

namespace versine::sensors {

namespace {
/// Turn of the gyroscopes about the vertical since the start, at the end of each sample.
class Turn {
 public:
  explicit Turn(const CheckedImu& imu) : imu_(imu) {
    sum_.reserve(imu.series.size());
    double total = 0.0;
    for (const ImuSample& s : imu.series) sum_.push_back(total += s.dtheta.z());
  }
  /// Between two times inside one segment; nothing otherwise.
  [[nodiscard]] std::optional<double> between(Time a, Time b) const {
    const std::size_t i = imu_.series.lower_bound(a), j = imu_.series.lower_bound(b);
    if (i == 0 || j >= imu_.series.size()) return std::nullopt;
    const auto segment = std::upper_bound(imu_.segments.begin(), imu_.segments.end(), i,
                                          [](std::size_t at, const Segment& s) { return at < s.end; });
    if (segment == imu_.segments.end() || j >= segment->end || i < segment->begin) return std::nullopt;
    return sum_[j] - sum_[i];
  }

 private:
  const CheckedImu& imu_;
  std::vector<double> sum_;
};

/// From one epoch to a later one, far enough for a direction.
struct Piece {
  std::size_t from, to;
  Eigen::Vector3d way;  ///< m, north, east, down
};

std::vector<Piece> pieces_of(const Series<GnssSample>& gnss) {
  std::vector<Piece> pieces;
  std::size_t from = 0;
  for (std::size_t i = 1; i < gnss.size(); ++i) {
    const Eigen::Vector3d d = geodesy::wgs84.ned_difference(gnss[from].position, gnss[i].position);
    const double sigma = std::hypot(gnss[i].sigma_ned.x(), gnss[i].sigma_ned.y());
    if (gnss[i].time - gnss[from].time > Duration{10'000'000'000}) {
      from = i;  // too long ago to say where the vehicle headed
    } else if (d.head<2>().norm() > std::max(2.0, 20.0 * std::min(sigma, 1.0))) {
      pieces.push_back({from, i, d});
      from = i;
    }
  }
  return pieces;
}

struct Course {
  Time time;
  double course;
};

std::vector<Course> courses_of(const Series<GnssSample>& gnss, const std::vector<Piece>& pieces) {
  std::vector<Course> courses;
  for (const Piece& p : pieces) {
    const Duration step = gnss[p.to].time - gnss[p.from].time;
    courses.push_back({gnss[p.from].time + Duration{step.ns / 2}, std::atan2(p.way.y(), p.way.x())});
  }
  return courses;
}

/// Sums for the slope of the course's change over the turn.
struct Slope {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  [[nodiscard]] double correlation() const { return xy / std::sqrt(xx * yy); }
};

// Bias makes the turn drift; over 20 s steps it stays small against a curve.
Slope slope_of(const CheckedImu& imu, const std::vector<Course>& courses) {
  const Turn turn(imu);
  Slope sums;
  std::size_t j = 0;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    while (j < courses.size() && courses[j].time - courses[i].time < Duration{4'000'000'000}) ++j;
    if (j == courses.size()) break;
    if (courses[j].time - courses[i].time > Duration{20'000'000'000}) continue;
    const auto x = turn.between(courses[i].time, courses[j].time);
    const double y = geodesy::wrap_pi(courses[j].course - courses[i].course);
    if (!x || std::abs(y) > 2.5) continue;  // near a half turn the sign is a guess
    sums.xx += *x * *x;
    sums.xy += *x * y;
    sums.yy += y * y;
  }
  return sums;
}

Expected<void> turn_fits(const Slope& sums, const std::string& file) {
  // Half a radian of turning in all, seen alike by both, or nothing can be said.
  if (!(sums.yy > 0.25) || !(sums.xx > 1e-8)) return {};
  const double correlation = sums.correlation();
  const double ratio = std::sqrt(sums.xx / sums.yy) * (correlation < 0.0 ? -1.0 : 1.0);  // gyroscopes over course
  if (std::abs(correlation) < 0.8) return {};
  const auto wrong = [&](std::string found, std::string advice) {
    return fail({.file = file,
                 .field = "course",
                 .found = std::move(found),
                 .expected = "the same turn from the gyroscopes and from the course over ground",
                 .advice = std::move(advice)});
  };
  if (ratio < 0.0 && ratio > -3.0) {
    return wrong("a course that turns left where the gyroscopes turn right",
                 "latitude and longitude look swapped (or north and east): correct [columns]; if they are right, the "
                 "gyroscopes' axes are not: correct axes");
  }
  if (std::abs(ratio) > 20.0) {
    return wrong(fmt::format("a turn of the gyroscopes {:.1f} times that of the course", std::abs(ratio)),
                 "degrees look like they were declared as radians: name the columns gyro_x_degps");
  }
  if (std::abs(ratio) < 0.05) {
    return wrong(fmt::format("a turn of the gyroscopes {:.4f} times that of the course", std::abs(ratio)),
                 "radians look like they were declared as degrees: name the columns gyro_x_radps");
  }
  return {};
}

// Position differences against the receiver's own velocities.
Expected<void> velocity_fits(const Series<GnssSample>& gnss, const std::vector<Piece>& pieces,
                             const std::string& file) {
  double right = 0.0, swapped = 0.0, size = 0.0;
  int count = 0;
  for (const Piece& p : pieces) {
    Eigen::Vector2d v = Eigen::Vector2d::Zero();
    std::size_t told = 0;
    for (std::size_t i = p.from; i <= p.to; ++i) {
      if (gnss[i].v_ned) v += gnss[i].v_ned->head<2>(), ++told;
    }
    if (told != p.to - p.from + 1) continue;
    const double dt = (gnss[p.to].time - gnss[p.from].time).seconds();
    v /= static_cast<double>(told);
    const Eigen::Vector2d d = p.way.head<2>() / dt;
    right += (d - v).squaredNorm();
    swapped += (Eigen::Vector2d(d.y(), d.x()) - v).squaredNorm();
    size += v.squaredNorm();
    ++count;
  }
  if (count < 4 || !(right > 0.25 * size) || !(swapped < 0.25 * right)) return {};
  return fail(
      {.file = file,
       .field = "latitude, longitude",
       .found = "positions that move east where the receiver's velocity says north",
       .expected = "positions and velocities that agree",
       .advice = "latitude and longitude (or velocity_north and velocity_east) look swapped: correct [columns]"});
}
}  // namespace

Expected<RunRecord> check_gnss_plausibility(const CheckedImu* imu, const Series<GnssSample>& gnss,
                                            const std::string& file) {
  RunRecord record;
  const std::vector<Piece> pieces = pieces_of(gnss);
  if (const auto fine = velocity_fits(gnss, pieces, file); !fine) return tl::unexpected(fine.error());
  if (imu != nullptr && imu->series.scale == gnss.scale) {
    if (const auto fine = turn_fits(slope_of(*imu, courses_of(gnss, pieces)), file); !fine) {
      return tl::unexpected(fine.error());
    }
  }
  return record;
}

Expected<void> check_gnss_way(const Series<GnssSample>& gnss, const Series<OdometerSample>& odometer,
                              const std::string& file) {
  double way = 0.0, told = 0.0, swapped = 0.0;
  const auto other_way_round = [](const geodesy::Geodetic& g) {
    return geodesy::Geodetic{g.longitude, g.latitude, g.height};
  };
  for (const Piece& p : pieces_of(gnss)) {
    const GnssSample &a = gnss[p.from], &b = gnss[p.to];
    const std::size_t i = odometer.lower_bound(a.time), j = odometer.lower_bound(b.time);
    if (i == 0 || j >= odometer.size()) continue;
    const auto distance = [&](std::size_t k, Time t) {
      const OdometerSample &before = odometer[k - 1], &after = odometer[k];
      const double share = (t - before.time).seconds() / (after.time - before.time).seconds();
      return before.distance + share * (after.distance - before.distance);
    };
    way += std::abs(distance(j, b.time) - distance(i, a.time));
    told += p.way.head<2>().norm();
    swapped += geodesy::wgs84.ned_difference(other_way_round(a.position), other_way_round(b.position)).head<2>().norm();
  }
  // 20 m or nothing can be said; a worn wheel or a chord is no tenth off.
  if (!(way > 20.0) || !(std::abs(told / way - 1.0) > 0.1) || !(std::abs(swapped / way - 1.0) < 0.05)) return {};
  return fail({.file = file,
               .field = "latitude, longitude",
               .found = fmt::format("positions that move {:.1f} m where the odometer counts {:.1f} m", told, way),
               .expected = "the same way from both",
               .advice = fmt::format("latitude and longitude look swapped (the other way round they move {:.1f} m): "
                                     "correct [columns]",
                                     swapped)});
}

}  // namespace versine::sensors
