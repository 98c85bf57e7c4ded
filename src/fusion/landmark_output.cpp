// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_output.hpp"

#include <cmath>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion::landmark {

namespace {

constexpr double speed_sigma = 0.01;  // m/s: an odometer differenced over a node interval

/// Error vector of the chain: position, attitude, then these.
constexpr int chain_scale = 6, chain_bias_x = 7, chain_bias_y = 8, chain_bias_z = 9, chain_levelling = 10,
              chain_size = 11;
using ChainMatrix = Eigen::Matrix<double, chain_size, chain_size>;

/// Everything that is interpolated between two nodes, as one array of floats and one of doubles.
struct NodeOutput {
  Eigen::Array4d correction;              ///< position error n (3), speed
  Eigen::Quaterniond rotation;            ///< from the nominal attitude to the corrected one
  Eigen::Array<float, 18, 1> covariance;  ///< position, velocity, attitude as Covariance3
};

/// Rotates roll and pitch errors, given about the trolley's axes, into the n-frame (Jiang eq. 4).
Eigen::Matrix2d to_north_east(double heading) {
  const double c = std::cos(heading), s = std::sin(heading);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  return R;
}

double node_heading(const Node& node, double heading) {
  return geodesy::to_euler(node.q_nv).yaw + heading;
}

void pack(Eigen::Array<float, 18, 1>& to, int at, const Eigen::Matrix3d& m) {
  to.segment<6>(at) << float(m(0, 0)), float(m(1, 1)), float(m(2, 2)), float(m(0, 1)), float(m(0, 2)), float(m(1, 2));
}
geodesy::Covariance3 unpack(const Eigen::Array<float, 18, 1>& from, int at) {
  return {from[at], from[at + 1], from[at + 2], from[at + 3], from[at + 4], from[at + 5]};
}

/// What errors of level and mounting, the same throughout the run, do to the landmark's lever arm: covariance, v-frame.
/// Roll comes from the accelerometers; pitch and heading of the IMU are those of the way it travels, seen through the
/// mounting.
Eigen::Matrix3d lever_covariance(const LandmarkOptions& o) {
  const Eigen::Vector3d sigma(o.levelling_sigma, o.mounting_sigma, o.mounting_sigma);
  const Eigen::Matrix3d shift = geodesy::skew(geodesy::to_matrix(o.mounting) * o.lever_landmark) * sigma.asDiagonal();
  return shift * shift.transpose();
}

NodeOutput node_output(const Node& node, const Smoothed& s, std::size_t k, double heading, double scale, double speed,
                       const Eigen::Matrix3d& lever) {
  const auto& v = s.vertical[k].estimate;
  const auto& l = s.level[k].estimate;
  const auto& r = s.roll[k].estimate;
  const double psi = node_heading(node, heading);
  const Eigen::Matrix2d R = to_north_east(psi);
  const Eigen::Vector2d tilt = R * Eigen::Vector2d(r.mean(roll::angle), v.mean(vertical::pitch));
  const Eigen::Quaterniond q = geodesy::from_rotation_vector({tilt.x(), tilt.y(), l.mean(level::heading)}) *
                               Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  NodeOutput o;
  o.rotation = q;
  o.correction << l.mean(level::north), l.mean(level::east), v.mean(vertical::position),
      speed * (1.0 - scale) * (1.0 - l.mean(level::scale));

  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  P.topLeftCorner<2, 2>() = l.covariance.topLeftCorner<2, 2>();
  P(2, 2) = v.covariance(0, 0);
  const Eigen::Matrix3d C_nv(Eigen::AngleAxisd(psi, Eigen::Vector3d::UnitZ()));
  P += C_nv * lever * C_nv.transpose();
  pack(o.covariance, 0, P);
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  const Eigen::Vector2d tilt_variance(r.covariance(roll::angle, roll::angle),
                                      v.covariance(vertical::pitch, vertical::pitch));
  A.topLeftCorner<2, 2>() = R * tilt_variance.asDiagonal() * R.transpose();
  A(2, 2) = l.covariance(level::heading, level::heading);
  // Velocity: turned by the attitude error, stretched by the scale's.
  const Eigen::Vector2d along(std::cos(psi), std::sin(psi)), aside(-along.y(), along.x());
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  V.topLeftCorner<2, 2>() = (speed * speed * l.covariance(level::scale, level::scale) + speed_sigma * speed_sigma) *
                                along * along.transpose() +
                            speed * speed * A(2, 2) * aside * aside.transpose();
  V(2, 2) = speed * speed * tilt_variance.y();
  pack(o.covariance, 6, V);
  pack(o.covariance, 12, A);
  return o;
}

/// Speed at a node from the steps on either side.
double node_speed(const std::vector<Node>& nodes, std::size_t k) {
  if (k == 0) return nodes.size() > 1 ? nodes[1].speed : 0.0;
  return k + 1 < nodes.size() ? 0.5 * (nodes[k].speed + nodes[k + 1].speed) : nodes[k].speed;
}

/// Blocks of the chain's error vector in terms of the channels' states: an orthogonal matrix.
ChainMatrix chain_frame(double psi) {
  // Rows: chain; columns: vertical (3), level (5), roll (3).
  constexpr int v = 0, l = vertical::size, r = vertical::size + level::size;
  ChainMatrix T = ChainMatrix::Zero();
  T(0, l + level::north) = T(1, l + level::east) = T(2, v + vertical::position) = 1.0;
  const Eigen::Matrix2d R = to_north_east(psi);
  for (int i = 0; i < 2; ++i) {
    T(3 + i, r + roll::angle) = R(i, 0);
    T(3 + i, v + vertical::pitch) = R(i, 1);
  }
  T(5, l + level::heading) = T(chain_scale, l + level::scale) = 1.0;
  T(chain_bias_x, r + roll::bias) = T(chain_bias_y, v + vertical::bias) = T(chain_bias_z, l + level::bias) = 1.0;
  T(chain_levelling, r + roll::levelling) = 1.0;
  return T;
}

template <class A, class B, class C>
ChainMatrix blocks(const A& vertical_block, const B& level_block, const C& roll_block) {
  ChainMatrix m = ChainMatrix::Zero();
  m.block<vertical::size, vertical::size>(0, 0) = vertical_block;
  m.block<level::size, level::size>(vertical::size, vertical::size) = level_block;
  m.block<roll::size, roll::size>(vertical::size + level::size, vertical::size + level::size) = roll_block;
  return m;
}

/// Nodes at least `interval` apart, the last one always.
std::vector<std::size_t> spaced(std::span<const Node> nodes, double interval) {
  std::vector<std::size_t> picked{0};
  const Duration step = Duration::from_seconds(interval);
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    if (nodes[k].time - nodes[picked.back()].time >= step || k + 1 == nodes.size()) picked.push_back(k);
  }
  return picked;
}

}  // namespace

geodesy::Trajectory corrected_trajectory(const Reckoning& reckoning, const sensors::ImuSeries& imu,
                                         const Smoothed& smoothed, double heading, double scale,
                                         const LandmarkOptions& options) {
  const auto& nodes = reckoning.nodes;
  const Eigen::Quaterniond q_vb = geodesy::to_quaternion(options.mounting);
  const Eigen::Vector3d lever = q_vb * options.lever_odometer;
  const bool has_lever = options.lever_odometer.squaredNorm() > 0.0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = to_north_east(heading);
  const Eigen::Matrix3d shared = lever_covariance(options);
  const std::int64_t spacing = options.output_rate > 0.0 ? Duration::from_seconds(1.0 / options.output_rate).ns : 0;
  std::int64_t next = nodes.front().time.ns;  // when the next point is due

  geodesy::Trajectory result;
  result.origin = "landmark dead reckoning, smoothed";
  const double run = (nodes.back().time - nodes.front().time).seconds();
  result.samples.reserve(spacing > 0 ? static_cast<std::size_t>(run * options.output_rate) + 2
                                     : reckoning.samples.size());
  NodeOutput a = node_output(nodes[0], smoothed, 0, heading, scale, node_speed(nodes, 0), shared);
  std::size_t i = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t base = k == 0 ? 0 : k - 1;
    const NodeOutput b = k == 0 ? a : node_output(nodes[k], smoothed, k, heading, scale, node_speed(nodes, k), shared);
    const geodesy::Geodetic& from = nodes[base].position;
    const double north = 1.0 / (geodesy::wgs84.meridian_radius(from.latitude) + from.height);
    const double east =
        1.0 / ((geodesy::wgs84.transverse_radius(from.latitude) + from.height) * std::cos(from.latitude));
    const double per_ns = k == 0 ? 0.0 : 1.0 / static_cast<double>((nodes[k].time - nodes[base].time).ns);
    const Eigen::Array4d slope = b.correction - a.correction;
    const Eigen::Array<float, 18, 1> covariance_slope = b.covariance - a.covariance;
    const Eigen::Vector4d q_base = (a.rotation * nodes[base].q_nv).coeffs(),
                          q_slope = (b.rotation * nodes[base].q_nv).coeffs() - q_base;
    const Eigen::Matrix3d C = (1.0 - scale) * turn * nodes[base].q_nv.toRotationMatrix();
    for (; i <= nodes[k].sample; ++i) {
      const Time time = imu[reckoning.first + i].time;
      if (time.ns < next) continue;
      if (spacing > 0) next += spacing * ((time.ns - next) / spacing + 1);
      const Between& between = reckoning.samples[i];
      const double u = per_ns * static_cast<double>((time - nodes[base].time).ns);
      const Eigen::Array4d c = a.correction + u * slope;
      const Eigen::Vector3d turned = between.turned.cast<double>();
      const Eigen::Quaterniond relative(std::sqrt(1.0 - turned.squaredNorm()), turned.x(), turned.y(), turned.z());
      const Eigen::Quaterniond q_nv = Eigen::Quaterniond(Eigen::Vector4d(q_base + u * q_slope)) * relative;
      Eigen::Vector3d at = C * between.way.cast<double>() - c.head<3>().matrix();
      auto& p = result.samples.emplace_back();
      p.time = time;
      p.v_eb_n = c[3] * Eigen::Vector3d(1.0 - 2.0 * (q_nv.y() * q_nv.y() + q_nv.z() * q_nv.z()),
                                        2.0 * (q_nv.x() * q_nv.y() + q_nv.w() * q_nv.z()),
                                        2.0 * (q_nv.x() * q_nv.z() - q_nv.w() * q_nv.y()));
      if (has_lever) at -= q_nv * lever;
      p.position = {from.latitude + north * at.x(), from.longitude + east * at.y(), from.height - at.z()};
      p.q_nb = q_nv * q_vb;
      p.q_nb.coeffs() *= 1.5 - 0.5 * p.q_nb.squaredNorm();  // one Newton step to unit length
      const Eigen::Array<float, 18, 1> v = a.covariance + static_cast<float>(u) * covariance_slope;
      p.position_covariance = unpack(v, 0);
      p.velocity_covariance = unpack(v, 6);
      p.attitude_covariance = unpack(v, 12);
    }
    a = b;
  }
  return result;
}

filter::ErrorChain error_chain(std::span<const Node> nodes, const Smoothed& s, double heading, double interval) {
  filter::ErrorChain chain;
  const auto picked = spaced(nodes, interval);
  for (std::size_t i = 0; i < picked.size(); ++i) {
    const std::size_t k = picked[i];
    const ChainMatrix T = chain_frame(node_heading(nodes[k], heading));
    const ChainMatrix P =
        T * blocks(s.vertical[k].estimate.covariance, s.level[k].estimate.covariance, s.roll[k].estimate.covariance) *
        T.transpose();
    Eigen::MatrixXf gain;
    if (i + 1 < picked.size()) {
      auto v = s.vertical[k].gain;
      auto l = s.level[k].gain;
      auto r = s.roll[k].gain;
      for (std::size_t j = k + 1; j < picked[i + 1]; ++j) {
        v = (v * s.vertical[j].gain).eval();
        l = (l * s.level[j].gain).eval();
        r = (r * s.roll[j].gain).eval();
      }
      const ChainMatrix next = chain_frame(node_heading(nodes[picked[i + 1]], heading));
      gain = (T * blocks(v, l, r) * next.transpose()).cast<float>();
    }
    chain.push_back(nodes[k].time, P.cast<float>(), std::move(gain));
  }
  return chain;
}

std::vector<std::string> sensor_error_names() {
  return {"odometer_scale", "gyro_bias_x", "gyro_bias_y", "gyro_bias_z", "levelling_roll"};
}

std::vector<SensorErrorSample> sensor_errors(std::span<const Node> nodes, const Smoothed& s,
                                             const Eigen::Vector3d& rate_bias, double scale, double interval) {
  std::vector<SensorErrorSample> samples;
  for (const std::size_t k : spaced(nodes, interval)) {
    const auto& v = s.vertical[k].estimate;
    const auto& l = s.level[k].estimate;
    const auto& r = s.roll[k].estimate;
    SensorErrorSample e{.time = nodes[k].time, .value = Eigen::VectorXf(5), .sigma = Eigen::VectorXf(5)};
    e.value << float(l.mean(level::scale) + scale), float(r.mean(roll::bias) + rate_bias.x()),
        float(v.mean(vertical::bias) + rate_bias.y()), float(l.mean(level::bias) + rate_bias.z()),
        float(r.mean(roll::levelling));
    e.sigma << float(std::sqrt(l.covariance(level::scale, level::scale))),
        float(std::sqrt(r.covariance(roll::bias, roll::bias))),
        float(std::sqrt(v.covariance(vertical::bias, vertical::bias))),
        float(std::sqrt(l.covariance(level::bias, level::bias))),
        float(std::sqrt(r.covariance(roll::levelling, roll::levelling)));
    samples.push_back(std::move(e));
  }
  return samples;
}

}  // namespace versine::fusion::landmark
