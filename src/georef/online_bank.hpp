// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>

#include "online_inertial.hpp"
#include "online_paths.hpp"
#include "versine/georef/online.hpp"

namespace versine::georef {

/// The hypotheses of OnlineGeoreferencer. Each knows a window of its path (what lies some hundred metres behind is cut
/// off) and the filter's state on it; the tracks that it came by are a tree that all share.
class OnlineGeoreferencer::Bank {
 public:
  Bank(const Map& map, const Options& options, const OnlineOptions& online);

  void add(const InertialSample& sample, bool has_turn_rate) { inertial_.add(sample, has_turn_rate); }
  std::optional<OnlinePosition> add(const Fix& fix);

  std::vector<OnlineDecision> decisions;
  std::size_t restarts = 0;

 private:
  /// A track as entered by some hypothesis.
  struct Node {
    network::OrientedTrack track;
    int parent = none;
    double odometer = 0.0;  ///< where it was entered, m since the start
    std::optional<Time> entered;
    OnlineDecision::Kind kind = OnlineDecision::Kind::leg;
  };
  static constexpr int none = -1;

  struct Hypothesis {
    std::shared_ptr<const network::PathCoordinates> path;
    std::vector<int> nodes;  ///< of the path's tracks
    double origin = 0.0;     ///< odometer at the path's beginning
    TrackerState state;
    double prior = 0.0;
    double probability = 0.0;

    [[nodiscard]] double odometer() const { return origin + state.x[0]; }
    [[nodiscard]] double log_weight() const { return state.log_likelihood + prior; }
    [[nodiscard]] std::size_t at() const;  ///< index of the track that it is on
  };

  /// What a fix says, after the checks.
  struct Seen {
    Time time;
    Eigen::Vector2d point;
    double sigma = 0.0;
    bool usable = false;  ///< for the distance
    std::optional<double> speed, receiver_speed;
    double sigma_speed = 0.0;
    bool standing = false;
  };
  [[nodiscard]] std::optional<Seen> look(const Fix& fix);
  void notice_standing(Seen& seen);

  void start(const Seen& seen);
  void step(const Seen& seen);
  void extend(Hypothesis h, const Seen& seen, const Epoch& epoch, std::int64_t steps, std::vector<Hypothesis>& out);
  [[nodiscard]] Hypothesis longer(const Hypothesis& h, const WayOn& way);
  void offer_reversals();
  void weigh(Time time);
  void merge_equal();
  void cut_behind(Hypothesis& h);
  void decide(Time time);
  void decide_on(int node, double probability, Time time);
  [[nodiscard]] bool revise();
  [[nodiscard]] int below(int node, int ancestor) const;
  [[nodiscard]] OnlinePosition position(Time time) const;
  void collect_nodes();

  const Map& map_;
  Options options_;
  OnlineOptions online_;
  OnlineInertial inertial_;
  Epochs with_imu_, without_imu_;
  std::vector<Node> nodes_;
  std::vector<Hypothesis> alive_;  // most probable first
  int decided_ = none;
  bool revising_ = false, reversals_offered_ = true, was_usable_ = false;
  std::deque<Seen> recent_;
  std::optional<Time> last_, still_since_;
  int lost_ = 0;
};

}  // namespace versine::georef
