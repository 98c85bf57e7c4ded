// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>

#include "versine/georef/georeference.hpp"
#include "versine/report/figure.hpp"
#include "versine/simulation/simulate.hpp"

/// Georeferenced journeys against the truth of their simulation.
namespace versine::benchmarks {

/// Right or wrong, by the probability that was told.
struct Decision {
  double probability;
  bool right;
};
struct Score {
  std::size_t journeys = 0, right = 0, failed = 0, hypotheses = 0, n_good = 0, n_bad = 0, inside = 0;
  double square_good = 0, square_bad = 0, seconds = 0, hours = 0, normalised = 0;
  std::vector<Decision> paths, switches;
};

void add(Score& to, const Score& s);

/// Adds one journey to a score. `bad` tells where GNSS has errors that the receiver does not know; `wrong` gets the
/// tracks driven and those found, when they differ.
void judge(const georef::Map& map, const georef::JourneyResult& journey, const simulation::SimulatedRecording& truth,
           const std::function<bool(const Eigen::Vector2d&)>& bad,
           const std::function<void(const std::vector<std::string>&, const std::vector<std::string>&)>& wrong,
           Score& score);

/// Decisions in bins of the probability told: Markdown rows, and points of a figure where ten or more are in a bin.
struct Reliability {
  std::string rows;
  report::Curve curve;
  double brier = 0.0;
};
[[nodiscard]] Reliability reliability(const std::string& name, const std::vector<Decision>& decisions);

}  // namespace versine::benchmarks
