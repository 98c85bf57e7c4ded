// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "versine/geodesy/attitude.hpp"
#include "versine/stationing/free_station.hpp"

/// Control network beside a track and readings of it, with known truth.
namespace versine::stationing::test {

inline constexpr double control_sigma = 0.5e-3;

/// Pairs every 60 m, 5 m left and right of a track that runs north-east, 1 m above it; not quite regular, as built.
inline std::vector<ControlPoint> pairs_along(double length, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  std::vector<ControlPoint> points;
  int number = 1;
  for (double s = 0.0; s <= length; s += 60.0) {
    for (const double side : {-5.0, 5.0}) {
      ControlPoint p{.name = "CP" + std::to_string(number++)};
      const double along = s + 0.3 * normal(rng), across = side + 0.1 * normal(rng);
      p.position = {std::sqrt(0.5) * (along - across), std::sqrt(0.5) * (along + across), -1.0 + 0.1 * normal(rng)};
      p.covariance = control_sigma * control_sigma * Eigen::Matrix3d::Identity();
      points.push_back(p);
    }
  }
  return points;
}

/// The same points as they really are: each off its coordinates by its sigma.
inline std::vector<ControlPoint> real_places(std::vector<ControlPoint> points, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  for (auto& p : points) p.position += control_sigma * Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
  return points;
}

struct Truth {
  Eigen::Vector3d position;
  Eigen::Quaterniond q_ms;
};

/// A trolley at mileage s: canted, on a gradient, the circle's zero anywhere.
inline Truth trolley(double s, std::mt19937& rng) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  return {{std::sqrt(0.5) * s, std::sqrt(0.5) * s, -0.5},
          geodesy::to_quaternion({.roll = 0.09 * any(rng), .pitch = 0.03 * any(rng), .yaw = 3.1 * any(rng)})};
}

struct Noise {
  double angle = 0.5 * units::arcsec;  ///< of the mean of two faces
  double distance = 0.6e-3, ppm = 1.0;
  double target = 0.1e-3;
  double collimation = 5 * units::arcsec, index = -3 * units::arcsec;
  double refraction = 0.13;
};

inline void sight(Stationing& s, const Truth& truth, const ControlPoint& real, const std::string& name, int sets,
                  bool two_faces, const Noise& noise, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d target = real.position + noise.target * Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
  const Eigen::Vector3d v = truth.q_ms.conjugate() * (target - truth.position);
  const double d = v.norm(), r = std::atan2(v.y(), v.x());
  const double h = std::hypot(v.x(), v.y());
  const double z = std::atan2(h, -v.z()) - noise.refraction * d / (2.0 * 6.371e6) * h / d;
  const double read = d + (noise.distance + 1e-6 * noise.ppm * d) * normal(rng);
  const double single = std::sqrt(2.0) * noise.angle;
  for (int set = 1; set <= sets; ++set) {
    Sighting one{.point = name,
                 .direction = r - noise.collimation / std::sin(z) + single * normal(rng),
                 .zenith = z + noise.index + single * normal(rng),
                 .distance = read,
                 .set = set};
    s.sightings.push_back(one);
    if (!two_faces) continue;
    Sighting two = one;
    two.face = Face::two;
    two.direction = r + std::numbers::pi + noise.collimation / std::sin(z) + single * normal(rng);
    two.zenith = 2.0 * std::numbers::pi - z + noise.index + single * normal(rng);
    s.sightings.push_back(two);
  }
}

/// Readings to the `count` points nearest to the station.
inline Stationing readings(const Truth& truth, const std::vector<ControlPoint>& real, std::size_t count, int sets,
                           std::mt19937& rng, bool two_faces = true, const Noise& noise = {}) {
  std::vector<const ControlPoint*> near;
  for (const auto& p : real) near.push_back(&p);
  std::sort(near.begin(), near.end(), [&](auto* a, auto* b) {
    return (a->position - truth.position).norm() < (b->position - truth.position).norm();
  });
  Stationing s{.name = "S"};
  for (std::size_t i = 0; i < count; ++i) sight(s, truth, *near[i], near[i]->name, sets, two_faces, noise, rng);
  return s;
}

}  // namespace versine::stationing::test
