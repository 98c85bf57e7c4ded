// SPDX-License-Identifier: Apache-2.0
#include "versine/track/odometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::track {
namespace {

using Odometer = Series<sensors::OdometerSample>;

/// The trajectory as an odometer, signed along the trolley's axis.
struct Way {
  Odometer level;         ///< horizontal, m
  Odometer rail;          ///< along the slope, as a wheel counts it, m
  double variance = 0.0;  ///< of the horizontal way from end to end, m^2
};

Way way_of(const geodesy::Trajectory& trajectory, const Eigen::Vector3d& forward) {
  Way out;
  out.level.scale = out.rail.scale = trajectory.scale;
  double level = 0.0, rail = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Vector3d x = trajectory[i].q_nb * forward;
    const Eigen::Vector3d along = Eigen::Vector3d(x.x(), x.y(), 0.0).normalized();
    if (i > 0) {
      const Eigen::Vector3d d = geodesy::wgs84.ned_difference(trajectory[i - 1].position, trajectory[i].position);
      level += d.dot(along);
      rail += d.dot(x);
    }
    if (i == 0 || i + 1 == trajectory.size()) {
      out.variance += along.dot(trajectory[i].position_covariance.matrix() * along);
    }
    out.level.samples.push_back({trajectory[i].time, level});
    out.rail.samples.push_back({trajectory[i].time, rail});
  }
  return out;
}

/// Times at which the first wheel has gone on by `window`; a comparison over less would see only counting steps.
std::vector<Time> windows(const Odometer& odometer, double window) {
  std::vector<Time> out{odometer.front().time};
  double last = odometer.front().distance;
  for (const auto& s : odometer) {
    if (std::abs(s.distance - last) < window) continue;
    out.push_back(s.time);
    last = s.distance;
  }
  if (out.back() < odometer.back().time) out.push_back(odometer.back().time);
  return out;
}

double median(std::vector<double> x) {
  if (x.empty()) return 1.0;
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

/// Ratio of increments of `b` to those of `a`: wheel radii differ.
double ratio(const Odometer& a, const Odometer& b, std::span<const Time> times) {
  std::vector<double> r;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double da = distance_at(a, times[k]) - distance_at(a, times[k - 1]);
    const double db = distance_at(b, times[k]) - distance_at(b, times[k - 1]);
    if (std::abs(da) > 1e-3) r.push_back(db / da);
  }
  return median(std::move(r));
}

}  // namespace

QuadratureResult decode_quadrature(std::span<const QuadratureSample> samples, double metres_per_edge) {
  QuadratureResult out;
  int count = 0, last = -1;
  for (const QuadratureSample& s : samples) {
    const int phase = s.a ? (s.b ? 2 : 1) : (s.b ? 3 : 0);  // order of a forward turn
    if (last >= 0) {
      const int step = (phase - last + 4) % 4;
      if (step == 1) ++count;
      if (step == 3) --count;
      if (step == 2) ++out.illegal;
    }
    last = phase;
    out.odometer.samples.push_back({s.time, count * metres_per_edge});
  }
  return out;
}

double distance_at(const Odometer& odometer, Time t) {
  const std::size_t i = odometer.lower_bound(t);
  if (i == 0) return odometer.front().distance;
  if (i == odometer.size()) return odometer.back().distance;
  const auto &a = odometer[i - 1], &b = odometer[i];
  return a.distance + (b.distance - a.distance) * ((t - a.time).seconds() / (b.time - a.time).seconds());
}

CombinedOdometer combine_odometers(std::span<const Odometer> odometers, const geodesy::Trajectory* trajectory,
                                   const OdometerOptions& options, RunRecord& record) {
  std::vector<Odometer> wheels;
  for (const Odometer& o : odometers) {
    if (o.size() > 1) wheels.push_back(o);
  }
  CombinedOdometer result{{}, 1.0, options.scale_sigma};
  if (wheels.empty()) return result;
  const bool has_way = trajectory != nullptr && trajectory->size() > 1;
  const Way way = has_way ? way_of(*trajectory, options.forward) : Way{};
  const Odometer& a = wheels[0];
  const Odometer& b = wheels.size() > 1 ? wheels[1] : (has_way ? way.rail : a);
  const std::vector<Time> times = windows(a, options.window);
  const double rb = ratio(a, b, times), rw = has_way ? ratio(a, way.rail, times) : 1.0;
  // Both wheels are brought to a common scale before they are compared; the mean keeps both calibrations' weight.
  const double to_mean = wheels.size() > 1 ? 0.5 * (1.0 + rb) : 1.0;
  Odometer& out = result.odometer;
  out.scale = a.scale;
  out.samples.push_back({times.front(), 0.0});
  double sum = 0.0, without_slip = 0.0, way_without_slip = 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const auto increment = [&](const Odometer& o) { return distance_at(o, times[k]) - distance_at(o, times[k - 1]); };
    const double da = increment(a), db = increment(b) / rb;
    double d = wheels.size() > 1 ? 0.5 * (da + db) : da;
    const bool slip = std::abs(da - db) > options.slip_distance;
    if (slip) {
      if (has_way) {
        const double dw = increment(way.rail) / rw;
        d = std::abs(da - dw) < std::abs(db - dw) || wheels.size() == 1 ? da : db;
        if (std::abs(d - dw) > options.slip_distance) d = dw;  // both slipped, or the only one did
      } else {
        d = std::abs(da) > std::abs(db) ? da : db;
      }
      record.findings.push_back({.sensor = "odometer",
                                 .kind = "slip",
                                 .from = times[k - 1],
                                 .to = times[k],
                                 .count = 1,
                                 .action = Finding::Action::repaired,
                                 .detail = fmt::format("{:.4f} m against {:.4f} m, taken {:.4f} m", da, db, d)});
    }
    double to_level = to_mean;
    if (has_way) {
      const double level = increment(way.level), rail = increment(way.rail);
      if (std::abs(rail) > 0.1 * options.window) to_level *= level / rail;
      if (!slip) {
        without_slip += d * to_level;
        way_without_slip += level;
      }
    }
    sum += d * to_level;
    // Within the window the first wheel's own course is kept.
    for (std::size_t i = a.lower_bound(times[k - 1]) + 1; i < a.lower_bound(times[k]) && !slip; ++i) {
      const double part = std::abs(da) > 1e-6 ? (a[i].distance - distance_at(a, times[k - 1])) / da : 0.0;
      out.samples.push_back({a[i].time, sum - d * to_level * (1.0 - part)});
    }
    out.samples.push_back({times[k], sum});
  }
  const double prior = options.scale_sigma * options.scale_sigma;
  if (has_way && prior > 0.0 && std::abs(without_slip) > 10.0 * options.window) {
    const double measured = way.variance / (way_without_slip * way_without_slip);
    const double weight = prior / (prior + measured);
    result.scale = 1.0 + weight * (way_without_slip / without_slip - 1.0);
    result.scale_sigma = std::sqrt(weight * measured);
    for (auto& s : out.samples) s.distance *= result.scale;
  }
  return result;
}

}  // namespace versine::track
