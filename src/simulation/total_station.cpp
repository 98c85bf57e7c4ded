// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/geodesy/attitude.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
using Eigen::Vector3d;

/// Pairs of control points on both sides, as CPIII networks have them: "0123L", "0123R". Only where there are rails.
std::vector<stationing::ControlPoint> true_control_points(const World& world, const TotalStationModel& model) {
  std::vector<stationing::ControlPoint> points;
  if (world.rails.distance.empty()) return points;
  RandomStream random(1, "total_station.points");  // the network stands there, whatever the run
  const double length = world.rails.distance.back();
  int pair = 0;
  for (double s = 0.0; s <= length + model.pair_spacing; s += model.pair_spacing, ++pair) {
    const auto rails = world.curve.value(std::min(s, length + 20.0));
    const Vector3d axis = 0.5 * (rails.head<3>() + rails.tail<3>());
    const Vector3d across = (rails.tail<3>() - rails.head<3>()).normalized();
    for (const double side : {-1.0, 1.0}) {
      // Beyond the end the pair stands along the last direction.
      const Vector3d place = axis + side * model.point_side * across +
                             Vector3d(0.2 * random.normal(), 0.2 * random.normal(), -model.point_height);
      points.push_back({fmt::format("{:03d}{}", pair, side < 0.0 ? 'L' : 'R'), place, Eigen::Matrix3d::Zero()});
    }
  }
  return points;
}

double circle(double angle) {
  const double turn = 2.0 * std::numbers::pi;
  return angle - turn * std::floor(angle / turn);
}

stationing::Sighting sight(const Vector3d& target_s, const std::string& name, const TotalStationModel& model,
                           RandomStream& random) {
  const double distance = target_s.norm();
  stationing::Sighting s;
  s.point = name;
  const double horizontal = std::hypot(target_s.x(), target_s.y());
  double along = (model.sigma_distance + model.sigma_distance_ppm * distance) * random.normal();
  double right = model.sigma_angle * random.normal(), up = model.sigma_angle * random.normal();
  if (random.chance(model.sighting_blunder)) {
    // A reflection, a wrong prism or a knock: one of the three readings is off.
    const double size = model.sighting_blunder_size * (random.chance(0.5) ? 1.0 : -1.0);
    const double which = random.uniform();
    (which < 1.0 / 3 ? along : which < 2.0 / 3 ? right : up) += which < 1.0 / 3 ? size : size / distance;
  }
  s.direction = circle(std::atan2(target_s.y(), target_s.x()) + right * distance / std::max(horizontal, 0.1));
  // Light bends towards the Earth: the target looks higher.
  constexpr double earth_radius = 6371000.0;
  s.zenith = std::acos(-target_s.z() / distance) - 0.5 * model.refraction * distance / earth_radius + up;
  s.distance = distance + along;
  return s;
}
}  // namespace

void observe_total_station(const World& world, const TotalStationModel& model, std::uint64_t seed,
                           SimulatedRecording& recording) {
  const bool positions = model.output != TotalStationModel::Output::readings;
  const bool readings = model.output != TotalStationModel::Output::positions;
  RandomStream random(seed, "total_station"), sightings(seed, "total_station.readings");
  const auto points = readings ? true_control_points(world, model) : std::vector<stationing::ControlPoint>{};
  recording.control_points = points;
  for (stationing::ControlPoint& p : recording.control_points) {
    RandomStream coordinates(seed, "total_station.point." + p.name);
    p.position += model.sigma_point * coordinates.normal3();
    p.covariance = Eigen::Matrix3d::Identity() * model.sigma_point * model.sigma_point;
  }
  const Eigen::Matrix3d C_vs = geodesy::to_matrix(model.mounting);
  double last = 1e300;  // distance of the last stationing
  int number = 0;
  for (const Stop& stop : world.stops) {
    const bool far = std::abs(stop.distance - last) >= model.every - 1.0;
    if (!far || stop.to - stop.from < model.shortest_stop) continue;
    last = stop.distance;
    const double t = 0.5 * (stop.from + stop.to);
    // The brake is on and the instrument needs a moment: a second at both ends belongs to the motion.
    const double margin = std::min(1.0, 0.1 * (stop.to - stop.from));
    const Time from = world.time(stop.from + margin), to = world.time(stop.to - margin);
    const Vector3d place = world.point(t, model.place);
    const std::string name = fmt::format("S{:03d}", ++number);
    if (positions) {
      sensors::LandmarkSample landmark;
      landmark.time = world.time(t);
      landmark.from = from, landmark.to = to;
      landmark.name = name;
      Vector3d error = model.sigma_position * random.normal3();
      if (random.chance(model.blunder)) error += model.blunder_size * random.normal3().normalized();
      landmark.position = geodesy::wgs84.displaced(world.frame.to_geodetic(place), error);
      landmark.covariance = Eigen::Matrix3d::Identity() * model.sigma_position * model.sigma_position;
      recording.landmarks.push_back(landmark);
    }
    if (readings) {
      const Eigen::Matrix3d C_ls = world.C_lv(t) * C_vs;
      std::vector<const stationing::ControlPoint*> near;
      for (const auto& p : points) near.push_back(&p);
      const auto count = std::min(near.size(), static_cast<std::size_t>(model.targets));
      std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                        [&](const auto* a, const auto* b) {
                          return (a->position - place).squaredNorm() < (b->position - place).squaredNorm();
                        });
      stationing::Stationing s;
      s.name = name;
      s.from = from, s.to = to;
      for (std::size_t i = 0; i < count; ++i) {
        s.sightings.push_back(sight(C_ls.transpose() * (near[i]->position - place), near[i]->name, model, sightings));
      }
      recording.stationings.push_back(std::move(s));
    }
  }
}

}  // namespace versine::simulation
