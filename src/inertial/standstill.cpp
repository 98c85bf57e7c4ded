// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/standstill.hpp"

#include <algorithm>
#include <cmath>

namespace versine::inertial {

using Eigen::Vector3d;

namespace {
/// Mean and spread of rate and specific force in one window.
struct Window {
  Time from, to;
  Vector3d rate_mean, rate_spread, force_mean, force_spread;
};

std::vector<Window> windows(const sensors::ImuSeries& imu, double length) {
  std::vector<Window> result;
  const double dt = imu.interval.seconds();
  const auto n = static_cast<std::size_t>(std::max(4.0, std::round(length / dt)));
  for (std::size_t a = 0; a + n <= imu.size(); a += n) {
    const auto nominal = static_cast<double>(n - 1) * dt;
    if ((imu[a + n - 1].time - imu[a].time).seconds() > 1.5 * nominal) continue;  // a gap: no verdict
    Vector3d rate = Vector3d::Zero(), rate2 = rate, force = rate, force2 = rate;
    for (std::size_t i = a; i < a + n; ++i) {
      const Vector3d w = imu[i].dtheta / dt, f = imu[i].dvel / dt - imu[a].dvel / dt;
      rate += w;
      rate2 += w.cwiseAbs2();
      force += f;
      force2 += f.cwiseAbs2();
    }
    const double k = 1.0 / static_cast<double>(n);
    const auto spread = [k](const Vector3d& sum, const Vector3d& squares) -> Vector3d {
      return (k * squares - (k * sum).cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    };
    result.push_back({imu[a].time - imu.interval, imu[a + n - 1].time, k * rate, spread(rate, rate2),
                      imu[a].dvel / dt + k * force, spread(force, force2)});
  }
  return result;
}

/// The value that a tenth of the windows stay below: what the sensor shows when nothing moves.
template <class Get>
double quietest(const std::vector<Window>& all, Get get) {
  std::vector<double> v;
  for (const Window& w : all) v.push_back(get(w));
  const auto tenth = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 10);
  std::nth_element(v.begin(), tenth, v.end());
  return *tenth;
}

bool odometer_agrees(const StandstillInput& in, Time from, Time to, double limit) {
  if (in.odometer == nullptr || in.odometer->empty()) return true;
  const auto before = [&](Time t) {
    const std::size_t i = in.odometer->lower_bound({t.ns + 1});
    return (*in.odometer)[i == 0 ? 0 : i - 1].distance;
  };
  return std::abs(before(to) - before(from)) <= limit;
}

/// Where the fixes on either side of a time put the antenna, as n-frame metres from `origin`, and their sigma.
std::optional<std::pair<Eigen::Vector2d, double>> place_at(const Series<sensors::GnssSample>& gnss, Time t,
                                                           const geodesy::Geodetic& origin) {
  constexpr double longest = 5.0;  // s between fixes that still tell a place in between
  const std::size_t after = gnss.lower_bound(t);
  if (after == 0 || after == gnss.size()) return std::nullopt;
  const auto &a = gnss[after - 1], &b = gnss[after];
  const double span = (b.time - a.time).seconds(), share = (t - a.time).seconds() / span;
  if (!(span <= longest)) return std::nullopt;
  const auto metres = [&](const geodesy::Geodetic& g) {
    constexpr double radius = 6371000.0;  // a standstill's limits need no ellipsoid
    return Eigen::Vector2d(radius * (g.latitude - origin.latitude),
                           radius * std::cos(origin.latitude) * (g.longitude - origin.longitude));
  };
  return std::pair{Eigen::Vector2d((1.0 - share) * metres(a.position) + share * metres(b.position)),
                   std::max(a.sigma_ned.head<2>().norm(), b.sigma_ned.head<2>().norm())};
}

/// Positions that wander off tell a steady ride from a standstill where nothing else does.
bool positions_agree(const StandstillInput& in, const StandstillOptions& o, Time from, Time to) {
  if (in.gnss == nullptr || in.gnss->empty()) return true;
  const geodesy::Geodetic origin = in.gnss->front().position;
  const auto a = place_at(*in.gnss, from, origin), b = place_at(*in.gnss, to, origin);
  if (!a || !b) return true;
  return (b->first - a->first).norm() <= o.gnss_speed * o.window + 3.0 * std::hypot(a->second, b->second);
}

bool aids_agree(const StandstillInput& in, const StandstillOptions& o, const Window& w) {
  if (!odometer_agrees(in, w.from, w.to, o.odometer_step)) return false;
  if (in.speed != nullptr) {
    for (const auto& s : in.speed->between(w.from, w.to)) {
      if (!(std::abs(s.speed) <= o.gnss_speed)) return false;
    }
  }
  if (!positions_agree(in, o, w.from, w.to)) return false;
  if (in.gnss != nullptr) {
    for (const auto& s : in.gnss->between(w.from, w.to)) {
      if (s.v_ned && !(s.v_ned->norm() <= o.gnss_speed + 3.0 * s.sigma_v_ned.norm())) return false;
    }
  }
  return true;
}
}  // namespace

std::vector<Interval> find_standstills(const StandstillInput& input, const StandstillOptions& o) {
  std::vector<Interval> result;
  if (input.imu == nullptr || input.imu->empty()) return result;
  const std::vector<Window> all = windows(*input.imu, o.window);
  if (all.empty()) return result;
  const double force_limit =
      std::max(o.acceleration_spread, 3.0 * quietest(all, [](const Window& w) { return w.force_spread.maxCoeff(); }));
  const double rate_limit =
      std::max(o.rate_spread, 3.0 * quietest(all, [](const Window& w) { return w.rate_spread.maxCoeff(); }));
  const auto quiet = [&](const Window& w) {
    return w.force_spread.maxCoeff() <= force_limit && w.rate_spread.maxCoeff() <= rate_limit;
  };
  // The gyros' bias, as the median over the quiet windows: what a standing IMU shows.
  Vector3d bias = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> v;
    for (const Window& w : all) {
      if (quiet(w)) v.push_back(w.rate_mean[axis]);
    }
    if (v.empty()) return result;
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    bias[axis] = *middle;
  }
  const Duration margin = Duration::from_seconds(o.margin);
  std::optional<Interval> open;
  Vector3d force_open = Vector3d::Zero();
  const auto close = [&] {
    if (open && open->seconds() >= o.minimum) result.push_back({open->from + margin, open->to - margin});
    open.reset();
  };
  for (const Window& w : all) {
    if (!quiet(w) || !((w.rate_mean - bias).cwiseAbs().maxCoeff() <= o.rate_mean) || !aids_agree(input, o, w)) {
      close();
    } else if (open && (w.from - open->to).seconds() < 0.5 * o.window &&
               // A steady acceleration has no spread, but it is another force than that of rest.
               (w.force_mean - force_open).cwiseAbs().maxCoeff() <= force_limit &&
               odometer_agrees(input, open->from, w.to, 2.0 * o.odometer_step) &&
               positions_agree(input, o, open->from, w.to)) {
      open->to = w.to;
    } else {
      close();
      open = Interval{w.from, w.to};
      force_open = w.force_mean;
    }
  }
  close();
  return result;
}

}  // namespace versine::inertial
