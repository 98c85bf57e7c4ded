// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "versine/georef/journeys.hpp"

namespace versine::georef {

namespace {

/// What the IMU says about the movement along and around the vehicle, on the grid.
struct Inertial {
  std::vector<float> forward;  // m/s^2
  std::vector<float> turn;     // rad/s, clockwise seen from above
};

/// Speeds are known over a second around each fix: that much is taken off a standstill.
bool stands_at(const JourneySpan& span, Time t) {
  const auto margin = Duration::from_seconds(1.0);
  return std::any_of(span.stops.begin(), span.stops.end(),
                     [&](const Standstill& s) { return s.from + margin < t && t + margin < s.until; });
}

struct Sums {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double n = 0;
  void add(const Eigen::Vector3d& x) { mean += (x - mean) / ++n; }
};

/// Which way is forward in the sensor's axes: the direction whose acceleration explains the changes of GNSS speed.
/// Its sign is that of the journey, so that a vehicle running backwards accelerates positively too.
Eigen::Vector3d forward_axis(std::span<const InertialSample> imu, std::span<const Fix> fixes,
                             const Eigen::Vector3d& mean, const std::optional<Eigen::Vector3d>& given) {
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  std::size_t k = 0;
  const auto speed = [&](std::size_t i, std::size_t j) {
    if (fixes[i].speed && fixes[j].speed) return *fixes[j].speed - *fixes[i].speed;
    if (i == 0 || j + 1 >= fixes.size()) return 0.0;
    const auto v = [&](std::size_t m) {
      const double dt = (fixes[m + 1].time - fixes[m - 1].time).seconds();
      return (fixes[m + 1].place - fixes[m - 1].place).norm() / dt;
    };
    return v(j) - v(i);
  };
  for (std::size_t i = 0, j = 0; i < fixes.size(); i = j) {
    j = i + 1;
    while (j < fixes.size() && (fixes[j].time - fixes[i].time).seconds() < 2.0) ++j;
    if (j >= fixes.size()) break;
    const double dt = (fixes[j].time - fixes[i].time).seconds();
    if (dt > 5.0) continue;
    Sums s;
    while (k < imu.size() && imu[k].time < fixes[i].time) ++k;
    for (; k < imu.size() && imu[k].time < fixes[j].time; ++k) s.add(imu[k].acceleration - mean);
    if (s.n < 5) continue;
    b += s.mean * (speed(i, j) / dt);
  }
  if (given) return (given->normalized()) * (b.dot(*given) < 0.0 ? -1.0 : 1.0);
  // Gravity's direction cannot be forward.
  const Eigen::Vector3d up = mean.normalized();
  b -= up * up.dot(b);
  return b.norm() > 1e-9 ? Eigen::Vector3d(b.normalized()) : Eigen::Vector3d::UnitX();
}

Inertial on_grid(const Recording& r, const JourneySpan& span, Time from, double grid, std::size_t steps,
                 const Options& options) {
  Inertial out;
  out.forward.assign(steps, 0.0F);
  const Time to = from + Duration::from_seconds(grid * static_cast<double>(steps));
  const auto imu = r.imu.between(from, to);
  if (imu.empty()) return out;
  Sums all, standing, standing_turn;
  for (const auto& s : imu) {
    all.add(s.acceleration);
    const bool stands = stands_at(span, s.time);
    if (stands) standing.add(s.acceleration), standing_turn.add(s.turn_rate);
  }
  const auto fixes = r.gnss.between(from, to);
  const Eigen::Vector3d axis = forward_axis(imu, fixes, all.mean, options.forward_axis);
  // Bias and gravity's share from standstill; without one the filter's own state takes it up.
  const double bias = axis.dot(standing.n > 50 ? standing.mean : all.mean);
  const Eigen::Vector3d down = -all.mean.normalized();
  if (r.has_turn_rate) out.turn.assign(steps, 0.0F);
  const double turn_bias = standing_turn.n > 50 ? down.dot(standing_turn.mean) : 0.0;
  std::size_t filled = 0;
  for (const auto& s : imu) {
    const auto k = std::min(static_cast<std::size_t>(std::max(0.0, (s.time - from).seconds() / grid + 0.5)), steps - 1);
    const auto a = static_cast<float>(axis.dot(s.acceleration) - bias);
    const auto w = r.has_turn_rate ? static_cast<float>(down.dot(s.turn_rate) - turn_bias) : 0.0F;
    // A short gap holds the last value; a long one leaves the acceleration to the filter.
    const std::size_t reach = k - std::min(filled, k) < 20 ? std::min(filled, k) : k;
    for (std::size_t i = reach; i <= k; ++i) {
      out.forward[i] = a;
      if (r.has_turn_rate) out.turn[i] = w;
    }
    filled = k + 1;
  }
  return out;
}

}  // namespace

Epochs make_epochs(const Recording& r, const JourneySpan& span, Time from, Time to, const Options& options) {
  const bool inertial = !r.imu.between(from, to).empty();
  Epochs out;
  out.start = from;
  out.grid = inertial ? options.grid_with_imu : options.grid_without_imu;
  out.motion = inertial ? options.with_imu : options.without_imu;
  out.correlation_time = options.gnss.correlation_time;
  if (const auto first = r.gnss.lower_bound(from); first < r.gnss.size()) {
    out.start_point = r.gnss[first].place;
    out.start_sigma = fix_sigma(r.gnss[first], options.gnss);
  }
  const auto last = static_cast<std::int64_t>(std::floor((to - from).seconds() / out.grid + 0.5));
  const auto steps = static_cast<std::size_t>(last) + 1;
  Inertial imu;
  if (inertial) imu = on_grid(r, span, from, out.grid, steps, options);

  // Measurements at their grid steps, and a step a second where there are none.
  const auto second = std::max<std::int64_t>(1, std::llround(1.0 / out.grid));
  std::vector<Epoch>& es = out.epochs;
  const auto epoch_at = [&](std::int64_t step) -> Epoch& {
    if (es.empty()) es.push_back({});
    while (step - es.back().step > second) es.push_back({.step = es.back().step + second});
    if (es.back().step < step) es.push_back({.step = step});
    return es.back();
  };
  const auto end = to + Duration{1};
  std::size_t o = r.speed.empty() ? 0 : r.speed.lower_bound(from);
  for (std::size_t i = r.gnss.lower_bound(from); i < r.gnss.size() && r.gnss[i].time < end; ++i) {
    const Fix& f = r.gnss[i];
    for (; o < r.speed.size() && r.speed[o].time <= f.time; ++o) {
      Epoch& e = epoch_at(std::llround((r.speed[o].time - from).seconds() / out.grid));
      e.speed = std::abs(r.speed[o].speed);
      e.sigma_speed = options.gnss.speed_floor;
    }
    const double sigma = fix_sigma(f, options.gnss);
    Epoch& e = epoch_at(std::min<std::int64_t>(last, std::llround((f.time - from).seconds() / out.grid)));
    if (sigma <= options.inference.largest_sigma) {
      e.position = f.place;
      e.sigma = sigma;
      e.fix = i;
    }
    if (f.speed) {
      e.speed = *f.speed;
      e.sigma_speed =
          std::max(options.gnss.speed_floor, options.gnss.speed_scale * (f.sigma_speed > 0 ? f.sigma_speed : 0.1));
    }
    e.standing = stands_at(span, f.time);
  }
  epoch_at(last);

  if (!inertial) return out;
  const double T = out.grid;
  double turned = 0.0;
  std::int64_t since = 0;
  for (std::size_t i = 1; i < es.size(); ++i) {
    double d = 0.0, s = 0.0;
    for (std::int64_t k = es[i - 1].step; k < es[i].step; ++k) {
      const double a = imu.forward[static_cast<std::size_t>(k)];
      d += T * s + 0.5 * T * T * a;
      s += T * a;
      if (!imu.turn.empty()) turned += T * imu.turn[static_cast<std::size_t>(k)];
    }
    es[i].input = {d, s};
    if (!imu.turn.empty() && es[i].step - since >= second) {
      es[i].turn = turned;
      es[i].turn_seconds = T * static_cast<double>(es[i].step - since);
      turned = 0.0;
      since = es[i].step;
    }
  }
  out.acceleration = std::move(imu.forward);
  return out;
}

}  // namespace versine::georef
