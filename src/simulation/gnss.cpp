// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "versine/geodesy/attitude.hpp"
#include "versine/simulation/noise.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
using Eigen::Vector3d;

/// Episodes that begin as a Poisson process and last an exponential time.
class Episodes {
 public:
  Episodes(double per_hour, double mean_length, std::uint64_t seed, std::string_view name)
      : random_(seed, name), mean_wait_(per_hour > 0.0 ? 3600.0 / per_hour : 1e300), mean_length_(mean_length) {
    next_ = wait();
  }
  /// True within an episode; `fresh` at its first call.
  bool within(double t) {
    fresh = false;
    while (t > end_) {
      const double begin = next_;
      if (t < begin) return false;
      end_ = begin + random_.exponential(mean_length_);
      next_ = end_ + wait();
      fresh = true;
    }
    return true;
  }
  bool fresh = false;
  RandomStream& random() { return random_; }

 private:
  double wait() { return mean_wait_ >= 1e300 ? 1e300 : random_.exponential(mean_wait_); }
  RandomStream random_;
  double mean_wait_, mean_length_;
  double end_ = -1.0, next_ = 0.0;  // of the last episode; begin of the next
};
}  // namespace

Series<sensors::GnssSample> observe_gnss(const World& world, const GnssModel& model, std::uint64_t seed, Truth& truth) {
  RandomStream white(seed, "gnss.white"), state(seed, "gnss.state"), colour(seed, "gnss.colour");
  Episodes multipath(model.multipath_per_h, model.multipath_time, seed, "gnss.multipath");
  Episodes wrong(model.wrong_fix_per_h, model.wrong_fix_time, seed, "gnss.wrong");
  Episodes single(model.single_per_h, model.single_time, seed, "gnss.single");
  const double step = 1.0 / model.rate;
  const Vector3d sigma(model.sigma_horizontal, model.sigma_horizontal, model.sigma_vertical);
  const Vector3d coloured(model.correlated_horizontal, model.correlated_horizontal, model.correlated_vertical);
  std::vector<GaussMarkov> slow;
  for (int i = 0; i < 3; ++i) slow.emplace_back(1.0, model.correlation_time, step, colour);

  Series<sensors::GnssSample> series;
  series.scale = world.time_scale;
  const auto count = static_cast<std::size_t>(world.duration * model.rate);
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(world.trolley.mounting).transpose();
  double fixed_from = 0.0;
  Vector3d multipath_error = Vector3d::Zero(), wrong_error = Vector3d::Zero();
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) * step;
    const Vector3d wander(slow[0].next(colour), slow[1].next(colour), slow[2].next(colour));
    const Vector3d noise = white.normal3(), noise_v = white.normal3();
    const double distance = world.motion(t).distance;
    const bool out = std::any_of(model.outages.begin(), model.outages.end(),
                                 [&](const Stretch& s) { return distance >= s.from && distance <= s.to; });
    if (out) {
      fixed_from = 1e300;
      continue;
    }
    if (fixed_from >= 1e300) fixed_from = t + state.exponential(model.refix_time);
    const bool alone = single.within(t);
    const bool fixed = !alone && t >= fixed_from;
    const double factor = alone ? model.single_factor : fixed ? 1.0 : model.float_factor;
    Vector3d error = factor * (sigma.cwiseProduct(noise) + coloured.cwiseProduct(wander));
    if (multipath.within(t)) {
      if (multipath.fresh) multipath_error = model.multipath_sigma * multipath.random().normal3();
      error += multipath_error;
    }
    if (wrong.within(t)) {
      if (wrong.fresh) {
        wrong_error = wrong.random().normal3().normalized() *
                      wrong.random().uniform(model.wrong_fix_smallest, model.wrong_fix_largest);
      }
      if (fixed) error += wrong_error;
    }
    const BodyState body = world.state(t);
    const Vector3d arm_b = C_bv * model.antenna;
    const geodesy::Geodetic antenna = world.frame.to_geodetic(body.position + body.C_lb * arm_b);
    sensors::GnssSample s;
    s.time = world.time(t);
    s.position = geodesy::wgs84.displaced(antenna, error);
    s.sigma_ned = factor / model.sigma_factor * (sigma.cwiseAbs2() + coloured.cwiseAbs2()).cwiseSqrt();
    s.fix = alone ? sensors::FixType::single : fixed ? sensors::FixType::fixed : sensors::FixType::float_ambiguity;
    if (s.fix != sensors::FixType::fixed && state.chance(model.lying_fix)) s.fix = sensors::FixType::fixed;
    s.satellites = alone ? 6 : 14;
    if (model.velocity) {
      const Eigen::Matrix3d C_nl = world.frame.rotation_from(antenna).transpose();
      const double factor_v = alone ? 5.0 : 1.0;
      s.v_ned =
          C_nl * (body.velocity + body.C_lb * body.w_lb_b.cross(arm_b)) + factor_v * model.sigma_velocity * noise_v;
      s.sigma_v_ned = Vector3d::Constant(factor_v * model.sigma_velocity / model.sigma_factor);
    }
    series.samples.push_back(s);
    truth.gnss_error.push_back(error);
  }
  return series;
}

}  // namespace versine::simulation
