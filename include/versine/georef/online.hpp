// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "versine/georef/georeference.hpp"

/// Georeferencing while the vehicle runs (Roth 2018, outlook): the filter of on_path.hpp on a bank of path hypotheses
/// that branches at facing switches and prunes, fed sample by sample. What it says of now is final; which way a switch
/// was taken is told when it is known, with its probability.
namespace versine::georef {

struct OnlineOptions {
  double decide = 0.99;         ///< probability from which a leg counts as decided
  double prune = 1e-5;          ///< hypotheses less probable than this are dropped
  std::size_t hypotheses = 32;  ///< kept at most
};

/// Where the vehicle is, by all that was recorded until now.
struct OnlinePosition {
  Time time;
  network::OrientedTrack track;
  double track_distance = 0.0;      ///< from the beginning of the map's own line, m
  Eigen::Vector2d point{0.0, 0.0};  ///< map m relative to Network::origin
  double speed = 0.0;               ///< m/s, positive in the direction of `track`
  double sigma = 0.0;               ///< of the distance on the track, m
  double probability = 0.0;         ///< of being on this track, in whichever direction
  std::size_t hypotheses = 0;       ///< alive
};

/// A choice that became certain enough.
struct OnlineDecision {
  enum class Kind { start, leg, reversal } kind = Kind::leg;
  network::OrientedTrack from, to;  ///< `from` is the same as `to` at the start
  Time passed;                      ///< when `to` was entered
  Time decided;
  double metres = 0.0;       ///< run since
  double probability = 0.0;  ///< when it was decided
  bool revised = false;      ///< takes the place of an earlier decision that proved wrong
};

/// One vehicle, live. Samples come in order of time; what is not later than the one before is left out. Refers to the
/// map. Time and memory a sample do not grow with the journey.
class OnlineGeoreferencer {
 public:
  OnlineGeoreferencer(const Map& map, const Options& options, const OnlineOptions& online = {});
  OnlineGeoreferencer(OnlineGeoreferencer&&) noexcept;
  ~OnlineGeoreferencer();

  void add(const InertialSample& sample, bool has_turn_rate);
  /// The position after this fix; nothing while the vehicle is not on the map.
  std::optional<OnlinePosition> add(const Fix& fix);
  /// What was decided since the last call.
  [[nodiscard]] std::vector<OnlineDecision> take_decisions();

  /// How often the vehicle was lost and sought anew.
  [[nodiscard]] std::size_t restarts() const;

 private:
  class Bank;
  std::unique_ptr<Bank> bank_;
};

}  // namespace versine::georef
