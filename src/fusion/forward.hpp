// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aids.hpp"
#include "imu_walk.hpp"
#include "segment_start.hpp"
#include "steps.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/inertial/error_dynamics.hpp"

namespace versine::fusion::detail {

/// The forward Kalman filter over one segment: propagates, applies each aid at its own time, emits steps.
template <int N, int M>
class Forward {
 public:
  Forward(const AidedInsInput& input, const AidedInsOptions& options, const InsLayout& layout,
          const std::vector<inertial::Interval>& standstills, Judge& judge)
      : in_(input), o_(options), l_(layout), standstills_(standstills), judge_(judge), noise_(options, layout) {}

  /// `tick(fraction)` is called now and then; false stops the pass.
  template <class Tick>
  bool run(const Segment& segment, const Start& start, Steps& out, SegmentStart& report, Tick&& tick) {
    begin(segment, start, out);
    const std::vector<Event> events = events_between(in_, o_, segment.from, segment.to);
    const Duration interval = Duration::from_seconds(1.0 / o_.covariance_rate), slack{interval.ns / 4};
    ImuWalk walk(in_.imu, segment.begin, segment.begin);
    std::size_t event = 0;
    while (moment_.estimate.nav.time < segment.to) {
      const Time now = moment_.estimate.nav.time;
      // A step ends at the next event, or at the IMU sample that completes the covariance interval.
      Time end = grid_end(segment, walk.next(), now + interval);
      if (event < events.size() && events[event].time <= end + slack) end = std::min(segment.to, events[event].time);
      const std::size_t first_event = event;
      while (event < events.size() && events[event].time <= end) ++event;
      propagate(walk, end, std::span(events).subspan(first_event, event - first_event), out);
      for (std::size_t e = first_event; e < event; ++e) apply(events[e], out);
      apply_constraints(out);
      emit(walk.next(), out);
      note_alignment(start, report);
      if (out.steps.size() % 256 == 0 &&
          !tick((now - segment.from).seconds() / std::max(1e-9, (segment.to - segment.from).seconds()))) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] const InsEstimate& estimate() const { return moment_.estimate; }
  [[nodiscard]] const filter::StateMatrix<N>& covariance() const { return P_; }

 private:
  using Vector = filter::StateVector<N>;

  void begin(const Segment&, const Start& start, Steps& out) {
    started_ = start.estimate.nav.time;
    judge_.begin_segment(started_);
    // The segment before hands over what its last landmark shares.
    for (std::size_t i = in_.landmarks.lower_bound({start.estimate.nav.time.ns + 1}); i-- > 0 && !shared_place_;) {
      if (in_.landmarks[i].shared) shared_place_ = in_.landmarks[i].shared->place;
    }
    moment_.estimate = start.estimate;
    refresh();
    P_ = start.covariance;
    distance_known_ = false;
    emit(0, out);
    out.waypoints.back().next_sample = 0;
  }

  [[nodiscard]] Time grid_end(const Segment& s, std::size_t next, Time wanted) const {
    while (next + 1 < s.end && in_.imu[next].time < wanted) ++next;
    return in_.imu[next].time;
  }

  void refresh() { moment_.C_nb = moment_.estimate.nav.q_nb.toRotationMatrix(); }

  void propagate(ImuWalk& walk, Time end, std::span<const Event> events, Steps& out) {
    InsEstimate& e = moment_.estimate;
    const Time begin = e.nav.time;
    const bool held = stands_between(begin, end), changed = std::exchange(held_, held) != held;
    if (changed) odometer_in_hold_ = false, last_zero_ = begin;
    const bool resting = held && (begin - last_zero_).seconds() > o_.zero_interval - rest_window() - 0.5 * dt_;
    if (!resting) rest_way_.setZero(), rest_seconds_ = 0.0;
    const WheelVelocity wheel_before = wheel_velocity(on_wheels(moment_), l_);
    accumulator_.reset();
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    walk.advance(e.nav, moment_.C_nb, e.imu, end, held,
                 [&](const inertial::StepGeometry& g, const inertial::Increment& piece, const inertial::NavState&) {
                   accumulator_.add(g, piece);
                   turned += piece.rotation;
                   moment_.omega_ib_b = piece.rotation / piece.dt;
                   moment_.omega_nb_b = moment_.omega_ib_b - g.C_nb_middle.transpose() * (g.omega_ie + g.omega_en);
                   const Eigen::Vector3d wheel_b =
                       g.C_nb_middle.transpose() * g.v_middle + moment_.omega_nb_b.cross(e.wheel_lever);
                   way += e.C_vb * wheel_b * piece.dt;
                   if (resting) rest_way_ += g.v_middle * piece.dt, rest_seconds_ += piece.dt;
                 });
    if (held) way.setZero();
    e.distance += (1.0 + e.odometer_scale) * way.x();
    if constexpr (M == filter::moving_with_path) e.path += way.tail<2>();
    dt_ = (end - begin).seconds();
    mean_rate_ib_ = turned / dt_;
    way_ = std::abs(way.x());
    way_since_constraint_ += way_;
    // The estimate fades as its error does (NoiseModel), or the filter believes in a bias that is long gone.
    if (l_.gnss_bias.enabled()) e.gnss_bias *= std::exp(-dt_ / o_.gnss_bias_time);

    const Eigen::Matrix<float, 6, 1> kept = shared_kept(events);
    e.landmark_error.array() *= kept.array().cast<double>();

    const double rocking = changed ? o_.zero_position_sigma * o_.zero_position_sigma : 0.0;
    step_.noise = {dt_,
                   way_,
                   static_cast<float>(std::exchange(lost_position_, 0.0) + rocking),
                   static_cast<float>(std::exchange(lost_velocity_, 0.0)),
                   static_cast<float>(std::exchange(lost_path_, 0.0)),
                   kept,
                   !distance_known_ || restart_distance_};
    const auto reading =
        std::find_if(events.begin(), events.end(), [&](const Event& x) { return x.kind == Event::Kind::odometer; });
    if (reading != events.end() && step_.noise.new_distance) {
      e.distance = in_.odometer[reading->index].distance;
      anchored_ = distance_known_ = true;
      restart_distance_ = false;
    }
    fill_transition(wheel_before);
    filter::predict(P_, transition_);
    pack_transition(transition_, out.arena, step_);
    step_.first_row = out.rows.size();
    step_.rows = 0;
  }

  /// What a landmark among the events keeps of the error that those before it had in common.
  [[nodiscard]] Eigen::Matrix<float, 6, 1> shared_kept(std::span<const Event> events) {
    Eigen::Matrix<float, 6, 1> kept = Eigen::Matrix<float, 6, 1>::Ones();
    for (const Event& x : events) {
      if (x.kind != Event::Kind::landmark || !in_.landmarks[x.index].shared) continue;
      const auto& place = in_.landmarks[x.index].shared->place;
      if (shared_place_) kept = (*shared_place_ - place).array().exp().cast<float>();
      shared_place_ = place;
    }
    return kept;
  }

  /// The rows of position, velocity and attitude from the accumulated matrices; those of the wheels' ways from the
  /// wheels' velocity before and after (trapezoidal rule).
  void fill_transition(const WheelVelocity& before) {
    transition_.top.setZero(M, l_.size());
    for (int i = 0; i < 9; ++i) {
      const auto& row = accumulator_.rows()[static_cast<std::size_t>(i)];
      transition_.top.row(i).template head<9>() = row.template head<9>().matrix().transpose();
      transition_.top.row(i).template segment<12>(l_.gyro_bias.offset) =
          row.template segment<12>(9).matrix().transpose();
    }
    if (held_) transition_.top.template topRows<3>().setIdentity();
    noise_.fill(step_.noise, transition_);
    constexpr bool with_path = M == filter::moving_with_path;
    if (held_) {
      if (!step_.noise.new_distance) transition_.top(l_.distance.offset, l_.distance.offset) = 1.0;
      if constexpr (with_path) transition_.top.template block<2, 2>(l_.path.offset, l_.path.offset).setIdentity();
      return;
    }
    const WheelVelocity after = wheel_velocity(on_wheels(moment_), l_);
    if (!step_.noise.new_distance) {
      fill_way(l_.distance.offset, distance_rate(before, moment_, l_).H, distance_rate(after, moment_, l_).H);
    }
    if constexpr (with_path) {
      for (int i = 0; i < 2; ++i) fill_way(l_.path.offset + i, before.H.row(1 + i), after.H.row(1 + i));
    }
  }

  template <class Row>
  void fill_way(int d, const Row& before, const Row& after) {
    const int m = l_.size() - M;
    auto row = transition_.top.row(d);
    row.noalias() = after.template head<9>() * transition_.top.template topRows<9>();
    row.tail(m) += after.tail(m).cwiseProduct(transition_.decay.tail(m).transpose());
    row = (0.5 * dt_ * (row + before)).eval();
    row[d] += 1.0;
  }

  void apply(const Event& event, Steps& out) {
    const std::size_t i = event.index;
    const Time t = event.time;
    switch (event.kind) {
      case Event::Kind::gnss: {
        const sensors::GnssSample& s = in_.gnss[i];
        if (o_.use_gnss_position) {
          const Eigen::Vector3d sigma = (o_.gnss_sigma_scale * s.sigma_ned).cwiseMax(o_.gnss_sigma_minimum);
          update("gnss position", t, gnss_position(moment_, l_, s, sigma), false, out);
        }
        if (o_.use_gnss_velocity && s.v_ned) {
          const Eigen::Vector3d sigma = (o_.gnss_sigma_scale * s.sigma_v_ned).cwiseMax(1e-3);
          update("gnss velocity", t, gnss_velocity(moment_, l_, s, sigma), false, out);
        }
        break;
      }
      case Event::Kind::landmark: {
        const sensors::LandmarkSample& s = in_.landmarks[i];
        const Eigen::Vector3d& lever = o_.landmark_lever.l_b;
        const bool used = update("landmark", t, landmark_position(moment_, l_, s, lever), false, out);
        if (s.q_ns) {
          update("landmark attitude", t,
                 used ? landmark_attitude_after_position(moment_, l_, s, lever, o_.q_bs)
                      : landmark_attitude(moment_, l_, s, o_.q_bs),
                 false, out);
        }
        break;
      }
      case Event::Kind::heading:
        update("heading", t, vehicle_heading(moment_, l_, in_.heading[i].heading, in_.heading[i].sigma), true, out);
        break;
      case Event::Kind::odometer:
        // The first reading after a start is where the distance is counted from. While the wheel stands its readings
        // repeat one error: one of them is all that they tell.
        if (!std::exchange(anchored_, false) && !(held_ && std::exchange(odometer_in_hold_, true))) {
          update("odometer", t, odometer_distance(moment_, l_, in_.odometer[i], o_.odometer_sigma), true, out);
        }
        break;
      case Event::Kind::speed: {
        // Errors that stay alike count as white noise of the same power at low frequency.
        const double spacing = std::max(1e-3, (t - std::exchange(last_speed_, t)).seconds());
        const double sigma = o_.speed_sigma * std::sqrt(std::max(1.0, 2.0 * o_.speed_correlation_time / spacing));
        filter::Linearized l = forward_speed(moment_, l_, in_.speed[i], sigma);
        l.H.row(0) = distance_rate(on_wheels(moment_), l_).H;
        update("speed", t, l, true, out);
        break;
      }
    }
  }

  /// Times never go back from one call to the next.
  [[nodiscard]] bool stands_between(Time from, Time to) {
    while (standstill_ < standstills_.size() && standstills_[standstill_].to < from) ++standstill_;
    if (!o_.zero_velocity_after_alignment && (to - started_).seconds() > o_.alignment_duration) return false;
    return o_.zero_velocity && standstill_ < standstills_.size() && standstills_[standstill_].contains(from) &&
           standstills_[standstill_].contains(to);
  }

  void apply_constraints(Steps& out) {
    const Time t = moment_.estimate.nav.time;
    standing_ = stands_between(t, t);
    if (standing_) return apply_standstill(t, out);
    if (!o_.constraint) return;
    const double since = std::min(1.0, (t - last_constraint_).seconds());
    if (since < std::max(o_.constraint_interval, 0.75 / o_.covariance_rate)) return;
    last_constraint_ = t;
    const double way = std::max(1e-3, std::exchange(way_since_constraint_, 0.0));
    if constexpr (M == filter::moving_with_path) {
      update("wheel path", t, wheel_path(moment_, l_, o_.constraint_wander / std::sqrt(way)), true, out);
      return;
    }
    // The sideways angle stays alike over a wheelbase; taken as white at this rate it must be as much larger.
    const double speed = moment_.estimate.nav.v_eb_n.norm();
    const double alike = std::max(1.0, 2.0 * o_.constraint_correlation / std::max(1e-3, speed * since));
    const double angle = o_.constraint_angle * speed;
    filter::Linearized l = constraint(moment_, l_, std::sqrt(std::pow(o_.constraint_sigma, 2) + angle * angle * alike));
    l.H = wheel_velocity(on_wheels(moment_), l_).H.bottomRows<2>();
    update("constraint", t, l, true, out, o_.constraint_peak * speed);
  }

  /// Length of the mean that a zero velocity is taken of, s: averaging takes vibration and coarse counts off, and lets
  /// the accelerometers' own noise in; it may add a quarter to the variance.
  [[nodiscard]] double rest_window() const {
    const double noise = o_.imu_errors.accelerometer.random_walk, sigma = o_.zero_velocity_sigma;
    return std::min(o_.zero_interval, 0.75 * sigma * sigma / std::max(1e-30, noise * noise));
  }

  void apply_standstill(Time t, Steps& out) {
    if ((t - last_zero_).seconds() < o_.zero_interval - 0.5 * dt_) return;
    last_zero_ = t;
    const bool mean_known = rest_seconds_ > 1.5 * dt_;
    const double seconds = mean_known ? rest_seconds_ : 0.0, walk = o_.imu_errors.accelerometer.random_walk;
    // What stays within a distance of its place has a mean velocity of twice that, at most, over the time.
    const double rocking = mean_known ? std::sqrt(2.0) * o_.zero_position_sigma / seconds : 0.0;
    const double sigma =
        std::sqrt(std::pow(o_.zero_velocity_sigma, 2) + rocking * rocking + walk * walk * seconds / 3.0);
    const Eigen::Vector3d mean =
        mean_known ? Eigen::Vector3d(rest_way_ / seconds) : Eigen::Vector3d(moment_.estimate.nav.v_eb_n);
    rest_way_.setZero(), rest_seconds_ = 0.0;
    update("zero velocity", t, zero_velocity(moment_, l_, mean, seconds, sigma), true, out);
    InsMoment turning = moment_;
    turning.omega_nb_b += mean_rate_ib_ - turning.omega_ib_b;
    turning.omega_ib_b = mean_rate_ib_;
    const double rate_sigma = std::hypot(o_.zero_rate_sigma, o_.imu_errors.gyro.random_walk / std::sqrt(dt_));
    update("zero rate", t, zero_rate(turning, l_, rate_sigma), true, out);
  }

  /// `peak`: single errors may be so much larger than R tells before they count as faults. Returns whether the
  /// measurement was used.
  bool update(const char* sensor, Time t, filter::Linearized l, bool often, Steps& out, double peak = 0.0) {
    const int m = l.rows();
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, filter::max_rows, filter::max_states> a(
        m, l_.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, filter::max_rows, filter::max_rows> S = l.R;
    for (int i = 0; i < m; ++i) a.row(i).noalias() = l.H.row(i).lazyProduct(P_);
    S += a.lazyProduct(l.H.transpose());
    S.diagonal().array() += peak * peak;
    const Judge::Verdict verdict = judge_.judge(sensor, t, l, S, often);
    if (verdict == Judge::Verdict::doubt_filter) lose_trust(sensor, std::min(1e8, l.z.squaredNorm()));
    if (verdict != Judge::Verdict::use) return false;

    if (!filter::whiten(l)) return false;
    Vector x = Vector::Zero(l_.size());
    for (int i = 0; i < m; ++i) {
      const Vector h = l.H.row(i).transpose();
      const filter::UpdateRow<N> row = filter::update_row<N>(x, P_, h, l.z[i], 1.0);
      const auto n = static_cast<std::size_t>(l_.size());
      Row packed{static_cast<float>(row.innovation), static_cast<float>(row.variance), out.arena.take(n),
                 out.arena.take(n)};
      for (std::size_t k = 0; k < n; ++k) {
        packed.h[k] = static_cast<float>(row.h[static_cast<Eigen::Index>(k)]);
        packed.gain[k] = static_cast<float>(row.gain[static_cast<Eigen::Index>(k)]);
      }
      out.rows.push_back(packed);
      ++step_.rows;
    }
    filter::symmetrize<N>(P_);
    if (rest_seconds_ > 0.0) {  // the way of this window, as the better estimate would have had it
      const Eigen::Vector3d mean = rest_way_ / rest_seconds_;
      rest_way_ -= rest_seconds_ * (zero_velocity(moment_, l_, mean, rest_seconds_, 1.0).H * x);
    }
    moment_.estimate = without_error(moment_.estimate, l_, x);
    refresh();
    return true;
  }

  /// A sensor was rejected too often: what it measures becomes uncertain by as much as it contradicts.
  void lose_trust(std::string_view sensor, double square) {
    if (sensor == "odometer") {
      restart_distance_ = true;
    } else if (sensor == "gnss position" || sensor == "landmark") {
      lost_position_ = std::max(lost_position_, square);
      lost_velocity_ = std::max(lost_velocity_, 0.01 * square);
    } else if (sensor == "wheel path") {
      lost_path_ = std::max(lost_path_, square);
    } else {
      lost_velocity_ = std::max(lost_velocity_, square);
    }
  }

  void emit(std::size_t next_sample, Steps& out) {
    pack<N>(P_, out.arena, step_);
    out.steps.push_back(step_);
    out.waypoints.push_back({moment_.estimate, next_sample, held_});
  }

  /// The first standstill ends: what the fine alignment has reached.
  void note_alignment(const Start& start, SegmentStart& report) {
    if (!start.standing || report_done_) return;
    if (standing_) {
      report.fine_sigma = P_.diagonal().template segment<3>(l_.attitude.offset).cwiseSqrt();
      report.fine_attitude = geodesy::to_euler(moment_.C_nb);
    } else if (report.fine_sigma) {
      report_done_ = true;
    }
  }

  const AidedInsInput& in_;
  const AidedInsOptions& o_;
  const InsLayout& l_;
  const std::vector<inertial::Interval>& standstills_;
  Judge& judge_;
  NoiseModel noise_;
  InsMoment moment_;
  filter::StateMatrix<N> P_;
  filter::Transition<N, M> transition_;
  inertial::TransitionAccumulator accumulator_;
  Step step_;
  Eigen::Vector3d mean_rate_ib_ = Eigen::Vector3d::Zero(), rest_way_ = Eigen::Vector3d::Zero();
  double rest_seconds_ = 0.0;
  double dt_ = 0.0, way_ = 0.0, lost_position_ = 0.0, lost_velocity_ = 0.0, lost_path_ = 0.0,
         way_since_constraint_ = 0.0;
  bool distance_known_ = false, anchored_ = false, restart_distance_ = false, standing_ = false, report_done_ = false,
       held_ = false, odometer_in_hold_ = false;
  std::size_t standstill_ = 0;
  std::optional<Eigen::Matrix<double, 6, 1>> shared_place_;  ///< of the landmark before
  Time started_, last_speed_{INT64_MIN / 2}, last_zero_{INT64_MIN / 2}, last_constraint_{INT64_MIN / 2};
};

}  // namespace versine::fusion::detail
