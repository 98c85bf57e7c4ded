// SPDX-License-Identifier: Apache-2.0
#include "trajectory_columns.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::io {

namespace {
using geodesy::TrajectoryPoint;
using P = const TrajectoryPoint&;
using V = const PointView&;
constexpr double deg = units::deg;

// A variance that is not known (zero) has no sigma.
double sigma(float variance) {
  return variance > 0.0f ? std::sqrt(static_cast<double>(variance)) : std::numeric_limits<double>::quiet_NaN();
}
}  // namespace

std::vector<TrajectoryColumn> trajectory_columns(bool with_map) {
  std::vector<TrajectoryColumn> columns{{"latitude_deg", "deg", 11, [](P p, V) { return p.position.latitude / deg; }},
                                        {"longitude_deg", "deg", 11, [](P p, V) { return p.position.longitude / deg; }},
                                        {"height_m", "m", 5, [](P p, V) { return p.position.height; }}};
  if (with_map) {
    columns.push_back({"easting_m", "m", 5, [](P, V v) { return v.map.easting; }});
    columns.push_back({"northing_m", "m", 5, [](P, V v) { return v.map.northing; }});
  }
  const std::vector<TrajectoryColumn> rest{
      {"velocity_north_mps", "m/s", 6, [](P p, V) { return p.v_eb_n.x(); }},
      {"velocity_east_mps", "m/s", 6, [](P p, V) { return p.v_eb_n.y(); }},
      {"velocity_down_mps", "m/s", 6, [](P p, V) { return p.v_eb_n.z(); }},
      {"roll_deg", "deg", 7, [](P, V v) { return v.roll / deg; }},
      {"pitch_deg", "deg", 7, [](P, V v) { return v.pitch / deg; }},
      {"heading_deg", "deg", 7, [](P, V v) { return v.heading / deg; }},
      {"sigma_north_m", "m", 6, [](P p, V) { return sigma(p.position_covariance.xx); }},
      {"sigma_east_m", "m", 6, [](P p, V) { return sigma(p.position_covariance.yy); }},
      {"sigma_down_m", "m", 6, [](P p, V) { return sigma(p.position_covariance.zz); }},
      {"sigma_velocity_north_mps", "m/s", 7, [](P p, V) { return sigma(p.velocity_covariance.xx); }},
      {"sigma_velocity_east_mps", "m/s", 7, [](P p, V) { return sigma(p.velocity_covariance.yy); }},
      {"sigma_velocity_down_mps", "m/s", 7, [](P p, V) { return sigma(p.velocity_covariance.zz); }},
      {"sigma_tilt_north_deg", "deg", 7, [](P p, V) { return sigma(p.attitude_covariance.xx) / deg; }},
      {"sigma_tilt_east_deg", "deg", 7, [](P p, V) { return sigma(p.attitude_covariance.yy) / deg; }},
      {"sigma_heading_deg", "deg", 7, [](P p, V) { return sigma(p.attitude_covariance.zz) / deg; }},
      {"segment", "1", 0, [](P p, V) { return static_cast<double>(p.segment); }}};
  columns.insert(columns.end(), rest.begin(), rest.end());
  return columns;
}

PointView view_of(const TrajectoryPoint& point, const geodesy::Projection* projection) {
  const geodesy::Euler euler = geodesy::to_euler(point.q_nb);
  PointView view{euler.roll, euler.pitch, euler.yaw < 0.0 ? euler.yaw + 2.0 * std::numbers::pi : euler.yaw, {}};
  if (projection != nullptr) view.map = projection->forward(point.position);
  return view;
}

std::vector<std::size_t> decimated(const geodesy::Trajectory& trajectory, Duration interval) {
  std::vector<std::size_t> chosen;
  // Half a nominal sample early counts, so that jitter does not turn 10 Hz into 9.
  const Duration slack{trajectory.size() > 1 ? (trajectory[1].time - trajectory[0].time).ns / 2 : 0};
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const bool take = chosen.empty() || interval.ns <= 0 ||
                      trajectory[i].segment != trajectory[chosen.back()].segment ||
                      trajectory[i].time - trajectory[chosen.back()].time >= interval - slack;
    if (take) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace versine::io
