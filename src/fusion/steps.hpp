// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include "versine/filter/kernels.hpp"
#include "versine/fusion/ins_state.hpp"

namespace versine::fusion::detail {

/// What makes the noise and the decay of a step, kept instead of them.
struct StepNoise {
  double dt = 0.0;        ///< s
  double way = 0.0;       ///< m travelled
  float position = 0.0F;  ///< m^2 added: rocking where a standstill begins or ends, and lost trust in the filter
  float velocity = 0.0F;  ///< (m/s)^2 added after the filter lost trust in itself
  float path = 0.0F;      ///< m^2 added to the wheels' way sideways after a fault
  /// Where a landmark ends the step: how much of the landmarks' shared error stays; 1 elsewhere.
  Eigen::Matrix<float, 6, 1> shared_kept = Eigen::Matrix<float, 6, 1>::Ones();
  bool new_distance = true;  ///< the odometer's distance starts anew (or is not in use): nothing of its past is kept
};

/// Decay and noise of all states from the options (white noise of gyros and accelerometers is alike on the three axes,
/// so that it needs no attitude).
class NoiseModel {
 public:
  NoiseModel(const AidedInsOptions& o, const InsLayout& layout)
      : o_(o),
        l_(layout),
        gyro_(densities(o.imu_errors.gyro, o.instability)),
        accelerometer_(densities(o.imu_errors.accelerometer, o.instability)) {}

  template <int N, int M>
  void fill(const StepNoise& s, filter::Transition<N, M>& t) const {
    const int n = l_.size();
    t.decay.setOnes(n);
    t.noise.setZero(n);
    const auto set = [&](auto block, double variance) {
      t.noise.template segment<decltype(block)::size>(block.offset).setConstant(variance);
    };
    set(l_.position, double{s.position});
    set(l_.velocity, accelerometer_.white * s.dt + double{s.velocity});
    set(l_.attitude, gyro_.white * s.dt);
    set(l_.distance, s.new_distance ? 2.0 * o_.odometer_sigma * o_.odometer_sigma
                                    : o_.odometer_random_walk * o_.odometer_random_walk * s.way + 1e-14);
    if (l_.path.enabled()) set(l_.path, path_walk(s.way, s.dt) + double{s.path});
    set(l_.gyro_bias, gyro_.walk * s.dt);
    set(l_.accelerometer_bias, accelerometer_.walk * s.dt + o_.gravity_walk * o_.gravity_walk * s.way);
    set(l_.odometer_scale, o_.odometer_scale_walk * o_.odometer_scale_walk * s.dt);
    if (l_.gnss_bias.enabled()) {
      const double decay = std::exp(-s.dt / o_.gnss_bias_time);
      t.decay.template segment<3>(l_.gnss_bias.offset).setConstant(decay);
      // Half of the noise acts before the decay (filter::Transition): scaled so that the process is stationary.
      t.noise.template segment<3>(l_.gnss_bias.offset) =
          o_.gnss_bias_sigma().cwiseAbs2() * (2.0 * (1.0 - decay * decay) / (1.0 + decay * decay));
    }
    const auto fade = [&](auto block, int first) {
      for (int i = 0; block.enabled() && i < 3; ++i) {
        const double kept = double{s.shared_kept[first + i]}, square = kept * kept;
        t.decay[block.offset + i] = kept;
        t.noise[block.offset + i] = 2.0 * (1.0 - square) / (1.0 + square);
      }
    };
    fade(l_.landmark_position, 0);
    fade(l_.landmark_attitude, 3);
  }

 private:
  /// What a sideways angle and a velocity that are alike for a while add up to.
  [[nodiscard]] double path_walk(double way, double dt) const {
    return std::pow(o_.constraint_angle, 2) * way * std::max(way, 2.0 * o_.constraint_correlation) +
           std::pow(o_.constraint_sigma * dt, 2) + 1e-14;
  }
  /// Of a triad: of its white noise, and of the walk of its bias.
  struct Densities {
    double white = 0.0, walk = 0.0;
  };
  /// A slowly varying bias on top of a constant one. Gauss-Markov: a random walk that grows as the process does at
  /// first. Flicker of density B^2 / (pi f) is a sum of such processes of equal variance 0.366 B^2, two in each decade
  /// of correlation times; a bias state follows those longer than `corner`, whose walks sum to 1.07 B^2 / corner, and
  /// the shorter ones are white noise of 0.34 B^2 corner to it. The corner is 30 s, about what the aids take to tell a
  /// bias anew, or longer where that adds less than a quarter to the white noise.
  static Densities densities(const sensors::TriadErrors& e, BiasInstability kind) {
    const double white = e.random_walk * e.random_walk, square = e.bias_instability * e.bias_instability;
    const double rate = e.rate_random_walk * e.rate_random_walk;
    if (kind == BiasInstability::gauss_markov || !(square > 0.0)) {
      return {white, 2.0 * square / e.correlation_time + rate};
    }
    const double corner = std::clamp(0.25 * white / (0.34 * square), 30.0, 3600.0);
    return {white + 0.34 * square * corner, 1.07 * square / corner + rate};
  }
  const AidedInsOptions& o_;
  const InsLayout& l_;
  Densities gyro_, accelerometer_;
};

/// Room for numbers in large pieces: what a run of hours keeps is exactly as long as its states are many.
class Arena {
 public:
  [[nodiscard]] float* take(std::size_t count) {
    if (used_ + count > piece) pieces_.push_back(std::make_unique_for_overwrite<float[]>(piece)), used_ = 0;
    return pieces_.back().get() + std::exchange(used_, used_ + count);
  }
  void clear() { pieces_.clear(), used_ = piece; }

 private:
  static constexpr std::size_t piece = 1U << 18U;
  std::vector<std::unique_ptr<float[]>> pieces_;
  std::size_t used_ = piece;
};

/// A step of the forward pass as it is kept for the smoother: float but for the estimate (its 7 digits change a sigma
/// by 1e-6 of itself and a position by 1e-6 of what the smoother corrects). n states.
struct Step {
  StepNoise noise;
  std::size_t first_row = 0, rows = 0;
  float* covariance = nullptr;  ///< after the updates at the step's end: n (n + 1) / 2 of its upper triangle
  float* transition = nullptr;  ///< full rows less the identity, of the step: moving x n
};

struct Row {
  float innovation = 0, variance = 1;
  float* h = nullptr;     ///< n
  float* gain = nullptr;  ///< n
};

/// The estimate after the updates at a step's end, and where the IMU stands there.
struct Waypoint {
  InsEstimate estimate;
  std::size_t next_sample = 0;
  bool held = false;  ///< the step that ends here is part of a standstill: the position stays as it was
};

struct Steps {
  std::deque<Waypoint> waypoints;  ///< one more than steps would need: [0] is the start; step k ends at waypoint k
  std::deque<Step> steps;          ///< steps[0] holds the covariance at the start only
  std::deque<Row> rows;
  Arena arena;
};

template <int N>
void pack(const filter::StateMatrix<N>& P, Arena& arena, Step& s) {
  const auto n = static_cast<std::size_t>(P.cols());
  s.covariance = arena.take(n * (n + 1) / 2);
  std::size_t k = 0;
  for (Eigen::Index j = 0; j < P.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) s.covariance[k++] = static_cast<float>(P(i, j));
  }
}

template <int N>
void unpack(const Step& s, filter::StateMatrix<N>& P) {
  std::size_t k = 0;
  for (Eigen::Index j = 0; j < P.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) P(i, j) = P(j, i) = static_cast<double>(s.covariance[k++]);
  }
}

template <int N, int M>
void pack_transition(const filter::Transition<N, M>& t, Arena& arena, Step& s) {
  s.transition = arena.take(static_cast<std::size_t>(t.top.size()));
  for (Eigen::Index j = 0; j < t.top.cols(); ++j) {
    for (int i = 0; i < M; ++i) {
      s.transition[static_cast<std::size_t>(j * M + i)] = static_cast<float>(t.top(i, j) - (i == j ? 1.0 : 0.0));
    }
  }
}

template <int N, int M>
void unpack_transition(const Step& s, const NoiseModel& noise, filter::Transition<N, M>& t, int n) {
  t.top.resize(M, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (int i = 0; i < M; ++i) {
      t.top(i, j) = static_cast<double>(s.transition[static_cast<std::size_t>(j * M + i)]) + (i == j ? 1.0 : 0.0);
    }
  }
  noise.fill(s.noise, t);
}

}  // namespace versine::fusion::detail
