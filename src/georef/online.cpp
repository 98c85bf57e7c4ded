// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/online.hpp"

#include <algorithm>
#include <cmath>

#include "online_bank.hpp"
#include "versine/georef/journeys.hpp"

namespace versine::georef {

OnlineGeoreferencer::OnlineGeoreferencer(const Map& map, const Options& options, const OnlineOptions& online)
    : bank_(std::make_unique<Bank>(map, options, online)) {}
OnlineGeoreferencer::OnlineGeoreferencer(OnlineGeoreferencer&&) noexcept = default;
OnlineGeoreferencer::~OnlineGeoreferencer() = default;

void OnlineGeoreferencer::add(const InertialSample& sample, bool has_turn_rate) {
  bank_->add(sample, has_turn_rate);
}
std::optional<OnlinePosition> OnlineGeoreferencer::add(const Fix& fix) {
  return bank_->add(fix);
}
std::vector<OnlineDecision> OnlineGeoreferencer::take_decisions() {
  return std::exchange(bank_->decisions, {});
}
std::size_t OnlineGeoreferencer::restarts() const {
  return bank_->restarts;
}

namespace {
constexpr double stray_sigma = 300.0;  // m
}

OnlineGeoreferencer::Bank::Bank(const Map& map, const Options& options, const OnlineOptions& online)
    : map_(map), options_(options), online_(online), inertial_(options.forward_axis) {
  for (Epochs* model : {&with_imu_, &without_imu_}) {
    model->grid = options.grid_with_imu;
    model->correlation_time = options.gnss.correlation_time;
  }
  with_imu_.motion = options.with_imu;
  without_imu_.motion = options.without_imu;
}

std::size_t OnlineGeoreferencer::Bank::Hypothesis::at() const {
  const auto& starts = path->starts();
  const auto it = std::upper_bound(starts.begin() + 1, starts.end() - 1, state.x[0]);
  return static_cast<std::size_t>(it - starts.begin()) - 1;
}

std::optional<OnlineGeoreferencer::Bank::Seen> OnlineGeoreferencer::Bank::look(const Fix& fix) {
  if (last_ && !(*last_ < fix.time)) return std::nullopt;
  if (!(options_.gnss.sigma_of_type[static_cast<std::size_t>(fix.type)] > 0.0)) return std::nullopt;
  Seen s{fix.time, map_.network.to_map(fix.position), fix_sigma(fix, options_.gnss)};
  if (!s.point.allFinite()) return std::nullopt;
  // As offline: a fix far from any track, or with a large sigma, says nothing about the distance.
  s.usable =
      s.sigma <= options_.inference.largest_sigma && !map_.index.near(s.point, options_.inference.radius).empty();
  if (fix.speed && std::isfinite(*fix.speed)) {
    s.speed = s.receiver_speed = *fix.speed;
    s.sigma_speed = std::max(options_.gnss.speed_floor,
                             options_.gnss.speed_scale * (fix.sigma_speed > 0.0 ? fix.sigma_speed : 0.1));
  }
  while (recent_.size() > 1 && (s.time - recent_[1].time).seconds() >= 2.0) recent_.pop_front();
  if (!s.speed && s.usable && !recent_.empty()) {
    const double dt = (s.time - recent_.front().time).seconds();
    if (dt > 1.4 && dt < 4.0) s.speed = (s.point - recent_.front().point).norm() / dt;
  }
  notice_standing(s);
  if (s.usable) recent_.push_back(s);
  return s;
}

void OnlineGeoreferencer::Bank::notice_standing(Seen& s) {
  if (!s.speed || *s.speed > options_.journeys.standing) {
    still_since_.reset();
  } else if (!still_since_) {
    still_since_ = s.time;
  }
  s.standing = still_since_ && (s.time - *still_since_).seconds() > 3.0;
  if (!s.standing) reversals_offered_ = reversals_offered_ && !(s.speed && *s.speed > options_.journeys.slowest);
}

std::optional<OnlinePosition> OnlineGeoreferencer::Bank::add(const Fix& fix) {
  const auto seen = look(fix);
  if (!seen) return std::nullopt;
  if (alive_.empty()) {
    if (seen->usable) start(*seen);
    last_ = seen->time;
    return alive_.empty() ? std::nullopt : std::optional(position(seen->time));
  }
  step(*seen);
  last_ = seen->time;
  weigh(seen->time);
  // A good many fixes that fit no hypothesis: the vehicle is elsewhere.
  const bool fits = !seen->usable || alive_.front().state.weight > 0.0;
  lost_ = fits ? 0 : lost_ + 1;
  if (lost_ > 20) {
    ++restarts;
    lost_ = 0;
    alive_.clear(), nodes_.clear();
    decided_ = none;
    return std::nullopt;
  }
  decide(seen->time);
  if (seen->standing && !reversals_offered_) offer_reversals();
  return position(seen->time);
}

void OnlineGeoreferencer::Bank::start(const Seen& s) {
  // A vehicle may be moving when the first fix comes: its speed must be known, and its heading from the fixes before.
  if (!s.speed) return;
  const Eigen::Vector2d moved = s.point - recent_.front().point;
  const bool standing = *s.speed < options_.journeys.standing;
  if (!standing && moved.norm() < 3.0) return;
  const double a = options_.without_imu.sigma, v = standing ? 1.0 : 3.0, unknown = 3.0 * s.sigma + 3.0;
  for (const auto& hit : map_.index.near(s.point, std::max(options_.inference.radius, 4.0 * s.sigma))) {
    for (const bool reversed : {false, true}) {
      const network::OrientedTrack track{hit.track, reversed};
      Hypothesis h;
      h.path = std::make_shared<network::PathCoordinates>(map_.network, network::Path{track});
      const double d = reversed ? h.path->length() - hit.distance : hit.distance;
      const Eigen::Vector2d along = h.path->derivative(d, 4.0);
      if (!standing && along.dot(moved) < 0.0) continue;
      h.state.x << d, standing ? 0.0 : *s.speed, 0.0, 0.0;
      h.state.P = Eigen::Vector4d(unknown * unknown, v * v, a * a, 1.0).asDiagonal();
      h.origin = -d;
      nodes_.push_back({track, none, 0.0, s.time, OnlineDecision::Kind::start});
      h.nodes = {static_cast<int>(nodes_.size()) - 1};
      alive_.push_back(std::move(h));
    }
  }
  const Epoch here{.position = s.point, .sigma = s.sigma};
  for (auto& h : alive_) advance(*h.path, without_imu_, options_, here, 0, h.state);
  was_usable_ = false;
  if (!alive_.empty()) weigh(s.time);
}

void OnlineGeoreferencer::Bank::step(const Seen& s) {
  const auto moved = inertial_.at_fix(s.time, s.speed, s.standing);
  Epoch e;
  if (moved.usable) e.input = moved.input;
  if (s.usable) {
    e.position = s.point, e.sigma = s.sigma;
  } else if (alive_.front().state.P(0, 0) > 4.0 * stray_sigma * stray_sigma) {
    // A receiver's dead reckoning in a tunnel is hundreds of metres off, all to one side: it only keeps the distance
    // from running away.
    e.position = s.point, e.sigma = std::max(stray_sigma, s.sigma);
  }
  if (s.receiver_speed) e.speed = s.receiver_speed, e.sigma_speed = s.sigma_speed;
  e.standing = s.standing;
  e.turn = moved.turn, e.turn_seconds = moved.turn_seconds;
  Epochs& model = moved.usable ? with_imu_ : without_imu_;
  // Over a long silence coarser steps do as well.
  const double dt = (s.time - *last_).seconds();
  model.grid = dt > 5.0 ? 10.0 * options_.grid_with_imu : options_.grid_with_imu;
  const auto steps = std::max<std::int64_t>(1, std::llround(dt / model.grid));
  if (moved.usable != was_usable_) {
    // The third state means something else now: all of the acceleration, or what the IMU does not tell.
    for (auto& h : alive_) {
      h.state.x[2] = 0.0;
      h.state.P.row(2).setZero(), h.state.P.col(2).setZero();
      h.state.P(2, 2) = model.motion.sigma * model.motion.sigma;
    }
    was_usable_ = moved.usable;
  }
  std::vector<Hypothesis> branched;
  for (auto& h : alive_) extend(std::move(h), s, e, steps, branched);
  alive_ = std::move(branched);
  for (auto& h : alive_) {
    advance(*h.path, model, options_, e, steps, h.state);
    // A path is run through forwards.
    if (const double v = h.state.x[1], sv = std::sqrt(h.state.P(1, 1)); v < -0.3) {
      h.prior -= 0.5 * std::min(9.0, v * v / (sv * sv));
    }
  }
}

void OnlineGeoreferencer::Bank::extend(Hypothesis h, const Seen& s, const Epoch& e, std::int64_t steps,
                                       std::vector<Hypothesis>& out) {
  TrackerState ahead = h.state;
  const Epoch nothing{.input = e.input};
  advance(*h.path, was_usable_ ? with_imu_ : without_imu_, options_, nothing, steps, ahead);
  const double sigma = std::sqrt(ahead.P(0, 0)), reach = ahead.x[0] + 3.0 * sigma + 10.0,
               over = reach - h.path->length();
  if (over <= 0.0) {
    out.push_back(std::move(h));
    return;
  }
  const network::OrientedTrack last = h.path->path().back();
  const double diverging = options_.inference.diverging;
  if (sigma < 50.0) {
    const auto ways = ways_on(map_, last, over, diverging, 16);
    for (const auto& way : ways) out.push_back(longer(h, way));
    if (ways.empty()) out.push_back(std::move(h));
    return;
  }
  // After a long silence the vehicle may be anywhere: only a fix tells which ways are worth following.
  if (s.usable) {
    for (const auto& way :
         ways_to(map_, last, over, s.point, std::max(15.0, 4.0 * s.sigma), diverging, online_.hypotheses)) {
      out.push_back(longer(h, way));
    }
  }
  out.push_back(std::move(h));
}

OnlineGeoreferencer::Bank::Hypothesis OnlineGeoreferencer::Bank::longer(const Hypothesis& h, const WayOn& way) {
  Hypothesis out = h;
  network::Path path = h.path->path();
  path.insert(path.end(), way.tracks.begin(), way.tracks.end());
  out.path = std::make_shared<network::PathCoordinates>(map_.network, std::move(path));
  out.prior += way.prior;
  for (const auto& track : way.tracks) {
    const double start = out.path->starts()[out.nodes.size()];
    nodes_.push_back({track, out.nodes.back(), out.origin + start, {}, OnlineDecision::Kind::leg});
    out.nodes.push_back(static_cast<int>(nodes_.size()) - 1);
  }
  return out;
}

void OnlineGeoreferencer::Bank::offer_reversals() {
  reversals_offered_ = true;
  const std::size_t n = alive_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (alive_[i].probability < 1e-3) continue;
    Hypothesis back = alive_[i];
    const std::size_t at = back.at();
    const network::OrientedTrack track = back.path->path()[at].opposite();
    const double into = back.state.x[0] - back.path->starts()[at];
    back.path = std::make_shared<network::PathCoordinates>(map_.network, network::Path{track});
    const double odometer = back.odometer();
    // Everything along the path changes its sign, so that the covariance stays.
    back.state.x = -back.state.x;
    back.state.x[0] = back.path->length() - into;
    back.state.across = -back.state.across;
    back.origin = odometer - back.state.x[0];
    // While it stands nothing tells them apart: the direction so far is the one that is told.
    back.prior += std::log(0.4), alive_[i].prior += std::log(0.6);
    nodes_.push_back({track, back.nodes[at], odometer, {}, OnlineDecision::Kind::reversal});
    back.nodes = {static_cast<int>(nodes_.size()) - 1};
    alive_.push_back(std::move(back));
  }
}

OnlinePosition OnlineGeoreferencer::Bank::position(Time time) const {
  const Hypothesis& best = alive_.front();
  const std::size_t at = best.at();
  OnlinePosition p;
  p.time = time;
  p.track = best.path->path()[at];
  const auto& track = map_.network.tracks[p.track.track];
  const double into = std::clamp(best.state.x[0] - best.path->starts()[at], 0.0, track.line.length());
  p.track_distance = track.line_offset + (p.track.reversed ? track.line.length() - into : into);
  p.point = best.path->position(best.state.x[0]);
  p.speed = best.state.x[1];
  p.sigma = std::sqrt(best.state.P(0, 0));
  for (const auto& h : alive_) p.probability += h.path->path()[h.at()].track == p.track.track ? h.probability : 0.0;
  p.hypotheses = alive_.size();
  return p;
}

}  // namespace versine::georef
