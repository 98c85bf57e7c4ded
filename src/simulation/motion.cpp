// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/simulation/random.hpp"

namespace versine::simulation {

namespace {
/// Peak slope of the smoothstep 10 x^3 - 15 x^4 + 6 x^5.
constexpr double peak_slope = 1.875;

tl::unexpected<Error> refuse(std::size_t leg, std::string_view key, std::string found, std::string expected,
                             std::string advice) {
  return fail({.field = fmt::format("motion.leg[{}].{}", leg, key),
               .found = std::move(found),
               .expected = std::move(expected),
               .advice = std::move(advice)});
}

Expected<void> check_leg(const Leg& leg, std::size_t i, double at, double begin, double end) {
  if (!(leg.to >= begin - 1e-6 && leg.to <= end + 1e-6)) {
    return refuse(i, "to_m", fmt::format("{} m", leg.to), fmt::format("a place on the track, {} to {} m", begin, end),
                  "end the leg on the track, or make the track longer");
  }
  if (!(leg.speed > 0.0)) {
    return refuse(i, "speed_kmh", fmt::format("{} m/s", leg.speed), "a speed above zero, also backwards",
                  fmt::format("the leg never arrives at {} m; give a positive speed", leg.to));
  }
  if (!(leg.acceleration > 0.0)) {
    return refuse(i, "acceleration_mps2", fmt::format("{}", leg.acceleration), "an acceleration above zero",
                  "the leg never gets moving, so never arrives; 0.2 suits a trolley, 0.5 a train");
  }
  if (!(std::abs(leg.to - at) >= 1e-3)) {
    return refuse(i, "to_m", fmt::format("{} m, where the body already is", leg.to), "another place",
                  "take the leg out; a longer stop goes into the leg before ('stop_s')");
  }
  if (leg.stop_every > 0.0 && !(leg.stop_each > 0.0)) {
    return refuse(i, "stop_each_s", "nothing", "the length of the stops that 'stop_every_m' asks for",
                  "add for example 'stop_each_s = 30'");
  }
  return {};
}
}  // namespace

Expected<SpeedProfile> SpeedProfile::create(const Motion& motion, double begin, double end, std::uint64_t seed) {
  if (!(motion.start >= begin && motion.start <= end)) {
    return fail({.field = "motion.start_m",
                 .found = fmt::format("{} m", motion.start),
                 .expected = fmt::format("a place on the track, {} to {} m", begin, end),
                 .advice = "start on the track"});
  }
  SpeedProfile profile;
  profile.distance_ = motion.start;
  if (motion.stand > 0.0) profile.stand(motion.stand);
  for (std::size_t i = 0; i < motion.legs.size(); ++i) {
    const Leg& leg = motion.legs[i];
    if (auto good = check_leg(leg, i, profile.distance_, begin, end); !good) return tl::unexpected(good.error());
    const double direction = leg.to > profile.distance_ ? 1.0 : -1.0;
    if (leg.stop_every > 0.0) {
      // Stops lie at multiples of the spacing from the leg's beginning; one within a metre of its end is the end.
      const double from = profile.distance_;
      for (double d = leg.stop_every; d < std::abs(leg.to - from) - 1.0; d += leg.stop_every) {
        profile.travel(from + direction * d, leg);
        profile.stand(leg.stop_each);
      }
    }
    profile.travel(leg.to, leg);
    if (leg.stop > 0.0) profile.stand(leg.stop);
  }
  if (motion.unevenness > 0.0) {
    // Relative speed 1 + sum of A w cos(w t + phase): four incommensurable waves around the typical period.
    RandomStream random(seed, "motion.unevenness");
    for (const double ratio : {0.47, 0.83, 1.19, 2.03}) {
      const double rate = 2.0 * std::numbers::pi / (motion.unevenness_period * ratio);
      profile.waves_.push_back(
          {motion.unevenness / std::sqrt(2.0) / rate, rate, random.uniform(0.0, 2.0 * std::numbers::pi)});
    }
    for (Stop& stop : profile.stops_) stop = {profile.time_of(stop.from), profile.time_of(stop.to), stop.distance};
    profile.duration_ = profile.time_of(profile.duration_);
  }
  return profile;
}

SpeedProfile::Warp SpeedProfile::warp(double t) const {
  Warp warp{t, 1.0, 0.0};
  for (const Wave& w : waves_) {
    const double x = w.rate * t + w.phase;
    warp.u += w.amplitude * (std::sin(x) - std::sin(w.phase));
    warp.du += w.amplitude * w.rate * std::cos(x);
    warp.ddu -= w.amplitude * w.rate * w.rate * std::sin(x);
  }
  return warp;
}

double SpeedProfile::time_of(double u) const {
  double t = u;
  for (int i = 0; i < 50; ++i) {
    const Warp w = warp(t);
    t -= (w.u - u) / w.du;
    if (std::abs(w.u - u) < 1e-10) break;
  }
  return t;
}

void SpeedProfile::add(double length, double v0, double v1) {
  pieces_.push_back({duration_, length, distance_, v0, v1});
  duration_ += length;
  distance_ += 0.5 * (v0 + v1) * length;  // the smoothstep is symmetric
}

void SpeedProfile::stand(double seconds) {
  if (!stops_.empty() && stops_.back().to == duration_) {
    stops_.back().to += seconds;
  } else {
    stops_.push_back({duration_, duration_ + seconds, distance_});
  }
  add(seconds, 0.0, 0.0);
}

void SpeedProfile::travel(double to, const Leg& leg) {
  const double way = std::abs(to - distance_), direction = to > distance_ ? 1.0 : -1.0;
  // Speeding up and braking take v^2 peak / a together; a short way has a lower top speed.
  const double top = std::min(leg.speed, std::sqrt(way * leg.acceleration / peak_slope));
  const double ramp = peak_slope * top / leg.acceleration;
  add(ramp, 0.0, direction * top);
  add((way - top * ramp) / top, direction * top, direction * top);
  add(ramp, direction * top, 0.0);
  distance_ = to;
}

MotionState SpeedProfile::at(double t) const {
  const auto [u, du, ddu] = warp(t);
  if (pieces_.empty()) return {distance_, 0.0, 0.0};
  const auto next =
      std::upper_bound(pieces_.begin(), pieces_.end(), u, [](double x, const Piece& p) { return x < p.time; });
  const Piece& p = next == pieces_.begin() ? pieces_.front() : *std::prev(next);
  if (p.length <= 0.0 || (p.v0 == 0.0 && p.v1 == 0.0)) return {p.distance, 0.0, 0.0};
  const double x = std::clamp((u - p.time) / p.length, 0.0, 1.0), x2 = x * x, x3 = x2 * x;
  const double dv = p.v1 - p.v0;
  const double distance = p.distance + p.length * (p.v0 * x + dv * x3 * x * (2.5 + x * (x - 3.0)));
  const double speed = p.v0 + dv * x3 * (10.0 + x * (6.0 * x - 15.0));
  const double acceleration = dv / p.length * 30.0 * x2 * (1.0 + x * (x - 2.0));
  return {distance, speed * du, acceleration * du * du + speed * ddu};
}

Stretch SpeedProfile::reach() const {
  Stretch reach{distance_, distance_};
  for (const Piece& p : pieces_) {
    reach.from = std::min(reach.from, p.distance);
    reach.to = std::max(reach.to, p.distance);
  }
  return reach;
}

}  // namespace versine::simulation
