// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/simulation/scenario.hpp"

namespace versine::simulation {

/// Distance along the line and its derivatives at a time.
struct MotionState {
  double distance = 0.0;      ///< m
  double speed = 0.0;         ///< d distance / dt, m/s
  double acceleration = 0.0;  ///< m/s^2
};

/// A stop: from and to in s since the start.
struct Stop {
  double from = 0.0, to = 0.0, distance = 0.0;
};

/// Distance over time as the legs of a Motion give it. Speed changes along the quintic smoothstep, so acceleration and
/// jerk are continuous: the distance is three times continuously differentiable, and standing is exact. Unevenness
/// warps time between stops by a sum of sines, which keeps all that. Immutable.
class SpeedProfile {
 public:
  /// Fails, naming the leg, when it goes nowhere, or ends outside [begin, end].
  [[nodiscard]] static Expected<SpeedProfile> create(const Motion& motion, double begin, double end,
                                                     std::uint64_t seed);

  [[nodiscard]] double duration() const { return duration_; }
  [[nodiscard]] MotionState at(double t) const;
  [[nodiscard]] const std::vector<Stop>& stops() const { return stops_; }
  /// Smallest and largest distance on the way, m.
  [[nodiscard]] Stretch reach() const;

 private:
  /// Speed from v0 to v1 over a time, from a time and a distance on.
  struct Piece {
    double time, length, distance, v0, v1;
  };
  struct Wave {
    double amplitude, rate, phase;  ///< s, rad/s, rad
  };
  /// Time as the legs count it, u(t) = t + sum A (sin(w t + p) - sin(p)), with its derivatives; du/dt > 0.
  struct Warp {
    double u, du, ddu;
  };
  [[nodiscard]] Warp warp(double t) const;
  [[nodiscard]] double time_of(double u) const;
  void stand(double seconds);
  void travel(double to, const Leg& leg);
  void add(double length, double v0, double v1);

  std::vector<Piece> pieces_;
  std::vector<Stop> stops_;
  std::vector<Wave> waves_;
  double duration_ = 0.0, distance_ = 0.0;
};

}  // namespace versine::simulation
