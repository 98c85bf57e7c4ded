// SPDX-License-Identifier: Apache-2.0
#include "station_landmarks.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "versine/fusion/shared_errors.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::app {
namespace {

using sensors::LandmarkSample;
using stationing::StationResult;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A landmark with the causes of its error, the correction's rows (position, theta) still in the m-frame.
struct Caused {
  LandmarkSample landmark;
  std::vector<fusion::ErrorCause> causes;
};

/// A place in the survey frame with its covariance, as a landmark.
LandmarkSample landmark_at(const std::string& name, Time from, Time to, const Eigen::Vector3d& place,
                           const Eigen::Matrix3d& covariance, const geodesy::LocalFrame& frame) {
  LandmarkSample l{.time = from + Duration{(to - from).ns / 2}, .from = from, .to = to, .name = name};
  l.position = frame.to_geodetic(place);
  const Eigen::Matrix3d to_n = frame.rotation_from(l.position).transpose();
  l.covariance = to_n * covariance * to_n.transpose();
  return l;
}

/// The part of a station's error that comes from each of its control points.
std::vector<fusion::ErrorCause> control_causes(const StationResult& s, const stationing::ControlNetwork& network) {
  std::vector<fusion::ErrorCause> causes;
  for (const auto& t : s.targets) {
    const stationing::ControlPoint* p = network.find(t.point);
    if (!p || !(p->covariance.diagonal().minCoeff() > 0.0)) continue;
    causes.push_back({"point " + t.point, t.gain * Eigen::Matrix3d(p->covariance.llt().matrixL())});
  }
  return causes;
}

/// The whole error of a station that has measured several prisms: its control points', and that of its own readings.
std::vector<fusion::ErrorCause> station_causes(const StationResult& s, const stationing::ControlNetwork& network) {
  auto causes = control_causes(s, network);
  Matrix6 own = s.covariance.topLeftCorner<6, 6>() - fusion::shared_covariance(causes, causes);
  own.diagonal() *= 1.0 + 1e-9;  // its factor exists in spite of rounding
  causes.push_back({"station " + s.name, Matrix6(own.llt().matrixL())});
  return causes;
}

std::vector<LandmarkSample> in_order(std::vector<Caused> all, const geodesy::LocalFrame& frame, int rows) {
  std::sort(all.begin(), all.end(), [](const Caused& a, const Caused& b) { return a.landmark.time < b.landmark.time; });
  std::vector<std::vector<fusion::ErrorCause>> causes;
  for (Caused& c : all) {
    // The error of a position is the negative correction, that of an attitude is theta.
    const Eigen::Matrix3d to_n = frame.rotation_from(c.landmark.position).transpose();
    Matrix6 turn = Matrix6::Zero();
    turn.topLeftCorner<3, 3>() = -to_n;
    turn.bottomRightCorner<3, 3>() = to_n;
    for (auto& cause : c.causes) cause.effect = turn * cause.effect;
    causes.push_back(std::move(c.causes));
  }
  auto shared = fusion::share_errors(causes, rows);
  std::vector<LandmarkSample> landmarks;
  for (std::size_t i = 0; i < all.size(); ++i) {
    landmarks.push_back(std::move(all[i].landmark));
    landmarks.back().shared = shared[i];
  }
  return landmarks;
}

/// A station's pitch comes from the heights of the control points that its neighbours use for theirs; the filter would
/// take height and pitch for independent there. Heights tell it the slope between stations anyway, and the better.
void leave_pitch_open(std::vector<LandmarkSample>& landmarks, const Eigen::Vector3d& mounting) {
  constexpr double open = 1e-3;  // rad
  const Eigen::Quaterniond q_bs = geodesy::to_quaternion({mounting.x(), mounting.y(), mounting.z()});
  for (LandmarkSample& l : landmarks) {
    const Eigen::Vector3d across = (*l.q_ns * q_bs.conjugate()) * Eigen::Vector3d::UnitY();
    l.attitude_covariance += open * open * across * across.transpose();
  }
}

}  // namespace

std::vector<stationing::Stationing> take_prism(stationing::Stationing& s, const std::string& prism) {
  std::vector<stationing::Stationing> stops;
  for (const auto& r : s.sightings) {
    if (r.point != prism || !r.from || !r.to) continue;
    const bool same = !stops.empty() && stops.back().from == r.from;
    if (!same) {
      stops.push_back({.name = fmt::format("{}/{}", s.name, stops.size() + 1),
                       .atmosphere = s.atmosphere,
                       .from = r.from,
                       .to = r.to});
    }
    stops.back().sightings.push_back(r);
  }
  std::erase_if(s.sightings, [&](const auto& r) { return r.point == prism; });
  return stops;
}

std::vector<LandmarkSample> station_landmarks(const StationingOutcome& stations, const StationingProcessing& p) {
  std::vector<Caused> all;
  for (const StationResult& s : stations.run.stations) {
    if (!s.from || !s.to) continue;
    auto l = landmark_at(s.name, *s.from, *s.to, s.position, s.covariance.topLeftCorner<3, 3>(), stations.frame);
    if (p.mounting) {
      const Eigen::Matrix3d to_n = stations.frame.rotation_from(l.position).transpose();
      l.q_ns = Eigen::Quaterniond(to_n * s.q_ms.toRotationMatrix()).normalized();
      l.attitude_covariance = to_n * s.covariance.block<3, 3>(3, 3) * to_n.transpose();
      // The station's correction of the position is the negative error.
      l.position_attitude = -to_n * s.covariance.block<3, 3>(0, 3) * to_n.transpose();
      // The mounting's error is the same at all stations; as noise of n stations its variance must count n times.
      const double n = static_cast<double>(stations.run.stations.size());
      l.attitude_covariance += n * p.mounting_sigma * p.mounting_sigma * Eigen::Matrix3d::Identity();
    }
    all.push_back({std::move(l), control_causes(s, stations.network)});
  }
  auto landmarks = in_order(std::move(all), stations.frame, p.mounting ? 6 : 3);
  if (p.mounting) leave_pitch_open(landmarks, *p.mounting * units::deg);
  return landmarks;
}

std::vector<LandmarkSample> prism_landmarks(const StationingOutcome& stations, const PrismStops& stops,
                                            const StationingProcessing& p) {
  std::vector<Caused> all;
  for (const StationResult& s : stations.run.stations) {
    const auto causes = station_causes(s, stations.network);
    for (const auto& stop : stops.at(s.name)) {
      const auto target = stationing::reduce(stop, p.instrument);
      if (!target || target->targets.empty() || std::isnan(target->targets[0].distance)) continue;
      const auto place = stationing::locate(s, target->targets[0], p.instrument);
      Caused c{landmark_at(stop.name, *stop.from, *stop.to, place.position, place.covariance, stations.frame), causes};
      // The place moves with the station, and turns about it.
      for (auto& cause : c.causes) {
        cause.effect.topRows<3>() -= geodesy::skew(place.position - s.position) * cause.effect.bottomRows<3>();
        cause.effect.bottomRows<3>().setZero();
      }
      all.push_back(std::move(c));
    }
  }
  return in_order(std::move(all), stations.frame, 3);
}

}  // namespace versine::app
