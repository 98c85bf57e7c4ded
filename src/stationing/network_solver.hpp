// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/SparseCholesky>

#include "network_model.hpp"

/// The least squares of a network; network_adjustment.cpp decides what goes in and what to think of the outcome.
namespace versine::stationing {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// What one adjustment leaves behind for the tests.
struct NetworkOutcome {
  Eigen::VectorXd residuals;  ///< whitened
  Sparse jacobian;            ///< whitened; columns: points, then attitudes
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> normal;
  std::vector<std::size_t> sighting_row, control_row;  ///< first row; npos: not used
  int redundancy = 0;
  double squares = 0.0;
};
constexpr std::size_t npos = static_cast<std::size_t>(-1);

/// Of a sighting's residual: across, up, along, m.
Eigen::Vector3d sighting_sigma(const Target& t, const Instrument& instrument);

/// What is observed besides sightings and control points.
struct NetworkContext {
  const Instrument& instrument;
  const NetworkOptions& options;
  std::span<const StationFigure> figures;
};

/// Index of the station with that name.
std::optional<std::size_t> station_named(const NetworkModel& model, const std::string& name);

/// One least-squares solution from the model's values; the solution replaces them. Robust: a start for the next,
/// without an outcome.
void solve_network(NetworkModel& model, const NetworkContext& context, bool robust, NetworkOutcome& outcome);

}  // namespace versine::stationing
