// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_reckoning.hpp"

#include <fmt/format.h>

#include <cmath>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion::landmark {

namespace {

/// The odometer's distance at ascending times, linear between samples and constant outside them.
class DistanceAt {
 public:
  explicit DistanceAt(const Series<sensors::OdometerSample>& odometer) : samples_(odometer.samples) {}
  double operator()(Time t) {
    while (next_ < samples_.size() && samples_[next_].time < t) advance();
    if (next_ == 0) return samples_.front().distance;
    if (next_ == samples_.size()) return samples_.back().distance;
    return samples_[next_ - 1].distance + slope_ * static_cast<double>((t - samples_[next_ - 1].time).ns);
  }

 private:
  void advance() {
    ++next_;
    if (next_ < samples_.size()) {
      slope_ = (samples_[next_].distance - samples_[next_ - 1].distance) /
               static_cast<double>((samples_[next_].time - samples_[next_ - 1].time).ns);
    }
  }
  const std::vector<sensors::OdometerSample>& samples_;
  std::size_t next_ = 0;
  double slope_ = 0.0;
};

/// exp(rotation / 2) for the small rotations between samples; relative error below 1e-12 up to 0.05 rad.
Eigen::Quaterniond small_rotation(const Eigen::Vector3d& r) {
  const double h2 = 0.25 * r.squaredNorm();
  const double s = 0.5 * (1.0 - h2 / 6.0 * (1.0 - h2 / 20.0));
  return {1.0 - 0.5 * h2 * (1.0 - h2 / 12.0), s * r.x(), s * r.y(), s * r.z()};
}

/// First column of the rotation matrix: where the trolley's x axis points in n.
Eigen::Vector3d forward(const Eigen::Quaterniond& q) {
  return {1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()), 2.0 * (q.x() * q.y() + q.w() * q.z()),
          2.0 * (q.x() * q.z() - q.w() * q.y())};
}

/// The turn of the n-frame over a displacement on the ellipsoid (Groves eq. 5.44, integrated), rad.
Eigen::Vector3d transport(const Eigen::Vector3d& moved, double latitude) {
  const double R = geodesy::wgs84.a();  // 0.3 % off at most: 5e-10 rad a metre
  return Eigen::Vector3d(moved.y(), -moved.x(), -moved.y() * std::tan(latitude)) / R;
}

Eigen::Vector3d earth_rate(double latitude) {
  return geodesy::wgs84.omega() * Eigen::Vector3d(std::cos(latitude), 0.0, -std::sin(latitude));
}

Error gap_error(const sensors::ImuSample& before, double seconds, double metres) {
  return {
      .field = "imu",
      .found = fmt::format("a gap of {:.3f} s after {:.3f} s, in which the trolley moved {:.3f} m", seconds,
                           before.time.seconds(), metres),
      .expected = "gyro data without gaps while moving: the attitude cannot be carried over one",
      .advice = "survey the parts before and after the gap as separate runs, or use the aided INS, which re-aligns"};
}

Error not_a_number(Time t) {
  return {.field = "imu or odometer",
          .found = fmt::format("a value that is not a number before {:.3f} s", t.seconds()),
          .expected = "finite increments",
          .advice = "run the integrity checks on the recording first"};
}

/// Attitude and way of a node in the n-frame; `correction`: rotation beyond `turned`, rad, v-frame.
void carry(const Node& before, Node& node, const Eigen::Vector3d& correction, double& latitude) {
  const Eigen::Matrix3d C_nv = before.q_nv.toRotationMatrix();
  node.moved = C_nv * node.way;
  node.moment = (C_nv * node.way_moment).head<2>();
  node.q_nv = geodesy::from_rotation_vector(-transport(node.moved, latitude)) *
              (before.q_nv * node.turned * small_rotation(correction));
  node.q_nv.normalize();
  latitude += node.moved.x() / geodesy::wgs84.a();
}

}  // namespace

Expected<Reckoning> reckon(const sensors::ImuSeries& imu, const Series<sensors::OdometerSample>& odometer,
                           const StaticStart& start, const geodesy::Geodetic& place, const std::vector<Time>& stops,
                           const LandmarkOptions& options, Progress& progress) {
  const Eigen::Quaterniond q_vb = geodesy::to_quaternion(options.mounting);
  const Eigen::Matrix3d C_vb = q_vb.toRotationMatrix();
  const Eigen::Vector3d bias_v = C_vb * start.rate_bias;
  double latitude = place.latitude;
  const std::size_t n = imu.size();
  const std::int64_t interval = Duration::from_seconds(options.node_interval).ns;
  const std::int64_t nominal = imu.interval.ns > 0 ? imu.interval.ns : (imu[1].time - imu[0].time).ns;

  Reckoning result{.first = start.sample};
  result.samples.reserve(n - start.sample);
  result.samples.emplace_back();
  DistanceAt distance_at(odometer);
  double s = distance_at(imu[start.sample].time);
  result.nodes.push_back({.time = imu[start.sample].time, .q_nv = start.q_nb * q_vb.conjugate()});
  std::size_t stop = 0;
  const auto pass_stops = [&](Time t) {
    while (stop < stops.size() && stops[stop].ns <= t.ns + nominal / 2) ++stop;
  };
  pass_stops(result.nodes.front().time);
  const auto begin = [&](const Node& before) {
    return Node{.rate = bias_v + before.q_nv.conjugate() * earth_rate(latitude)};
  };
  Node node = begin(result.nodes.front());
  Time node_start = result.nodes.front().time;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // in the frame at the node before
  Eigen::Vector3d f = Eigen::Vector3d::UnitX(), last_dtheta = Eigen::Vector3d::Zero();

  for (std::size_t i = start.sample + 1; i < n; ++i) {
    const auto& sample = imu[i];
    const std::int64_t step = sample.time.ns - imu[i - 1].time.ns;
    const double dt = 1e-9 * static_cast<double>(step), now = distance_at(sample.time), ds = now - s;
    s = now;
    Eigen::Vector3d dtheta = C_vb * sample.dtheta;
    if (step > 5 * nominal) {
      if (std::abs(ds) > options.standing_tolerance) return fail(gap_error(imu[i - 1], dt, ds));
      dtheta = node.rate * dt;  // standing: the attitude holds
      node.integrated -= dt;
    }
    // Coning (Savage 1998) and the rate of the n-frame as seen from the trolley, both over this sample.
    q = q * small_rotation(dtheta + last_dtheta.cross(dtheta) / 12.0 - node.rate * dt);
    last_dtheta = dtheta;
    const Eigen::Vector3d g = forward(q), moved = (0.5 * ds) * (f + g);
    f = g;
    const double tau = 1e-9 * static_cast<double>(sample.time.ns - node_start.ns) - 0.5 * dt;
    node.way += moved;
    node.way_moment += tau * moved;
    node.distance += ds;
    node.distance_moment += tau * ds;
    result.samples.push_back({q.vec().cast<float>(), node.way.cast<float>()});

    const bool at_stop = stop < stops.size() && stops[stop].ns <= sample.time.ns + nominal / 2;
    if (!at_stop && sample.time.ns - node_start.ns < interval && i + 1 < n) continue;
    node.time = sample.time;
    node.sample = i - start.sample;
    node.turned = q;
    node.duration = (sample.time - node_start).seconds();
    node.integrated += node.duration;
    node.speed = node.distance / node.duration;
    carry(result.nodes.back(), node, Eigen::Vector3d::Zero(), latitude);
    if (!node.moved.allFinite() || !node.q_nv.coeffs().allFinite()) return fail(not_a_number(sample.time));
    result.nodes.push_back(node);
    pass_stops(sample.time);
    node_start = sample.time;
    node = begin(result.nodes.back());
    q.setIdentity();
    f = Eigen::Vector3d::UnitX();
    if (result.nodes.size() % 4096 == 0) {
      progress.report("dead reckoning", static_cast<double>(i) / static_cast<double>(n));
      if (progress.cancelled()) return fail({.found = "cancelled"});
    }
  }
  return result;
}

void restart(std::vector<Node>& nodes, const StaticStart& start, const geodesy::Geodetic& place,
             const LandmarkOptions& options) {
  const Eigen::Quaterniond q_vb = geodesy::to_quaternion(options.mounting);
  const Eigen::Vector3d bias_v = q_vb * start.rate_bias;
  double latitude = place.latitude;
  nodes.front().q_nv = start.q_nb * q_vb.conjugate();
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const Eigen::Vector3d rate = bias_v + nodes[k - 1].q_nv.conjugate() * earth_rate(latitude);
    carry(nodes[k - 1], nodes[k], (nodes[k].rate - rate) * nodes[k].integrated, latitude);
    nodes[k].rate = rate;
  }
}

void place_nodes(std::vector<Node>& nodes, double heading, double scale, std::size_t anchor,
                 const geodesy::Geodetic& position) {
  const double c = std::cos(heading) * (1.0 - scale), s = std::sin(heading) * (1.0 - scale);
  const auto turned = [&](const Eigen::Vector2d& d) {
    return Eigen::Vector2d(c * d.x() - s * d.y(), s * d.x() + c * d.y());
  };
  for (auto& node : nodes) {
    node.motion = {node.duration, node.distance * (1.0 - scale), node.distance_moment * (1.0 - scale),
                   turned(node.moved.head<2>()), turned(node.moment)};
  }
  const auto moved = [&](const Node& node) {
    return Eigen::Vector3d(node.motion.displacement.x(), node.motion.displacement.y(), node.moved.z() * (1.0 - scale));
  };
  nodes[anchor].position = position;
  for (std::size_t k = anchor + 1; k < nodes.size(); ++k) {
    nodes[k].position = geodesy::wgs84.displaced(nodes[k - 1].position, moved(nodes[k]));
  }
  for (std::size_t k = anchor; k > 0; --k) {
    nodes[k - 1].position = geodesy::wgs84.displaced(nodes[k].position, -moved(nodes[k]));
  }
}

}  // namespace versine::fusion::landmark
