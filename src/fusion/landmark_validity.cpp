// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_validity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion::landmark {

namespace {

/// Smallest and largest of what is seen.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double width() const { return high > low ? high - low : 0.0; }
};

/// Attitude every few metres: the shape of the line, not its irregularities.
constexpr double shape_step = 5.0;  // m

void measure(std::span<const Node> nodes, Stretch& s) {
  Range cant, heading, rate;
  double unwrapped = 0.0, last_heading = 0.0, since = shape_step, travelled = 0.0, elapsed = 0.0, last_shape = 0.0;
  bool begun = false;
  for (std::size_t k = s.first; k <= s.last; ++k) {
    if (k > s.first) {
      since += std::abs(nodes[k].motion.distance);
      travelled += std::abs(nodes[k].motion.distance);
      elapsed += nodes[k].duration;
    }
    if (since < shape_step && k != s.last) continue;
    const geodesy::Euler e = geodesy::to_euler(nodes[k].q_nv);
    const double turn = begun ? geodesy::wrap_pi(e.yaw - last_heading) : 0.0;
    unwrapped += turn;
    if (begun && elapsed > 0.0 && travelled - last_shape > 0.5 * shape_step) rate.add(turn / elapsed);
    cant.add(e.roll);
    heading.add(unwrapped);
    last_heading = e.yaw;
    last_shape = travelled;
    since = 0.0;
    elapsed = 0.0;
    begun = true;
  }
  s.length = travelled;
  s.duration = (nodes[s.last].time - nodes[s.first].time).seconds();
  s.cant_range = cant.width();
  s.heading_range = heading.width();
  s.heading_rate_range = rate.width();
  s.heading_rate = rate.high >= rate.low ? std::max(std::abs(rate.low), std::abs(rate.high)) : 0.0;
}

void judge(Stretch& s, const ModelErrors& e) {
  if (!(s.length > 1.0)) return;
  const double earth = geodesy::wgs84.omega(), north = earth * std::cos(e.latitude);
  const double G = s.cant_range, H = s.heading_range;
  // Jiang eq. 12: mounting angles turn with the cant. Scale factor and misalignment of the gyros act on the turn.
  const double pitch = std::hypot(e.mounting * G, e.gyro_misalignment * H);
  const double heading = std::hypot(e.mounting * G, e.gyro_scale * H, e.gyro_misalignment * G);
  // Jiang eq. 6: what a turn changes in the equivalent biases. Level errors stay in n while the trolley turns (eq. 4).
  const double lateral_bias = std::hypot(
      north * e.heading * H, std::hypot(e.level * s.heading_rate_range, e.level * s.heading_rate * H), e.bias * G);
  const double vertical_bias = std::hypot(north * e.level * H, e.bias * G);
  const double root = std::sqrt(s.length);
  s.noise = {pitch / root, heading / root, lateral_bias / root, vertical_bias / root};
  // Between two landmarks a slope that changes by a over the length L bows by a L / 8 at mid-interval; a rate that
  // changes evenly by w bows by 0.064 w L T (cubic parabola against its chord).
  const auto bow = [&](double a, double w) {
    return std::hypot(a * s.length / 8.0, 0.064 * w * s.length * s.duration);
  };
  s.model_error = std::max(bow(pitch, lateral_bias), bow(heading, vertical_bias));
}

}  // namespace

std::vector<Stretch> judge_stretches(std::span<const Node> nodes, std::span<const std::size_t> landmarks,
                                     const ModelErrors& errors) {
  std::vector<Stretch> stretches;
  std::size_t first = 0;
  double travelled = 0.0;
  const auto close = [&](std::size_t last) {
    if (last <= first) return;
    Stretch s{.first = first, .last = last, .begin = travelled};
    measure(nodes, s);
    travelled += s.length;
    judge(s, errors);
    stretches.push_back(s);
    first = last;
  };
  for (const std::size_t k : landmarks) close(k);
  close(nodes.size() - 1);
  return stretches;
}

}  // namespace versine::fusion::landmark
