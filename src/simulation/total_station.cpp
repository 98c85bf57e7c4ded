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

/// A point as the station sees it: angles without the instrument's axis errors, and the error of a blunder.
struct Seen {
  double direction = 0.0, zenith = 0.0, distance = 0.0;
  Vector3d blunder = Vector3d::Zero();  ///< across, up, along, m
};

Seen see(const Vector3d& target_s, const TotalStationModel& model, RandomStream& random) {
  const double distance = target_s.norm(), horizontal = std::hypot(target_s.x(), target_s.y());
  Seen s;
  if (random.chance(model.sighting_blunder)) {
    // A reflection, a wrong prism or a knock: one of the three readings is off, in all faces.
    const auto which = static_cast<Eigen::Index>(3.0 * random.uniform());
    s.blunder[std::min<Eigen::Index>(which, 2)] = model.sighting_blunder_size * (random.chance(0.5) ? 1.0 : -1.0);
  }
  s.direction = std::atan2(target_s.y(), target_s.x()) + s.blunder.x() / std::max(horizontal, 0.1);
  // Light bends towards the Earth: the target looks higher.
  constexpr double earth_radius = 6371000.0;
  s.zenith =
      std::acos(-target_s.z() / distance) - 0.5 * model.refraction * distance / earth_radius - s.blunder.y() / distance;
  // The error of a distance belongs to the line: reading it again does not change it.
  s.distance =
      distance + (model.sigma_distance + model.sigma_distance_ppm * distance) * random.normal() + s.blunder.z();
  return s;
}

/// The readings of a point in each face: collimation and index error have opposite signs in them.
void read(const Seen& seen, const std::string& point, const TotalStationModel& model, RandomStream& random,
          stationing::Stationing& station) {
  const double single = std::sqrt(2.0) * model.sigma_angle;  // of one face
  for (int face = 1; face <= model.faces; ++face) {
    const double sign = face == 1 ? -1.0 : 1.0, turned = face == 1 ? 0.0 : std::numbers::pi;
    const double right = single * random.normal(), up = single * random.normal();
    const double zenith = face == 1 ? seen.zenith : 2.0 * std::numbers::pi - seen.zenith;
    stationing::Sighting s{.point = point, .face = face == 1 ? stationing::Face::one : stationing::Face::two};
    s.direction = circle(seen.direction + turned + (sign * model.collimation + right) / std::sin(seen.zenith));
    s.zenith = zenith + model.index_error + up;
    s.distance = seen.distance;
    station.sightings.push_back(std::move(s));
  }
}

/// The coordinates that the user has: off the true places by their sigma, some by a movement since then.
std::vector<stationing::ControlPoint> told_coordinates(const std::vector<stationing::ControlPoint>& points,
                                                       const TotalStationModel& model, std::uint64_t seed,
                                                       Truth& truth) {
  std::vector<stationing::ControlPoint> told = points;
  for (stationing::ControlPoint& p : told) {
    RandomStream coordinates(seed, "total_station.point." + p.name);
    p.position += model.sigma_point * coordinates.normal3();
    p.covariance = Eigen::Matrix3d::Identity() * model.sigma_point * model.sigma_point;
  }
  RandomStream random(seed, "total_station.moved");
  while (truth.moved_points.size() < std::min(told.size(), static_cast<std::size_t>(model.moved_points))) {
    const auto i =
        std::min(told.size() - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(told.size())));
    if (std::count(truth.moved_points.begin(), truth.moved_points.end(), told[i].name) > 0) continue;
    told[i].position += model.moved_by * random.normal3().normalized();
    truth.moved_points.push_back(told[i].name);
  }
  return told;
}
}  // namespace

void observe_total_station(const World& world, const TotalStationModel& model, std::uint64_t seed,
                           SimulatedRecording& recording) {
  const bool positions = model.output != TotalStationModel::Output::readings;
  const bool readings = model.output != TotalStationModel::Output::positions;
  RandomStream random(seed, "total_station"), sightings(seed, "total_station.readings");
  const auto points = readings ? true_control_points(world, model) : std::vector<stationing::ControlPoint>{};
  recording.control_points = told_coordinates(points, model, seed, recording.truth);
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
        const Seen seen = see(C_ls.transpose() * (near[i]->position - place), model, sightings);
        read(seen, near[i]->name, model, sightings, s);
        if (!seen.blunder.isZero()) recording.truth.wrong_sightings.push_back({name, near[i]->name, seen.blunder});
      }
      recording.stationings.push_back(std::move(s));
    }
  }
}

}  // namespace versine::simulation
