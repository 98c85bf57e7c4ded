// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "versine/track/compute.hpp"

/// Versines and chord checks on a grid. Distances that are no multiples of the step are taken by cubic interpolation.
namespace versine::track {

/// Horizontal versine: `((P - A) x (B - A)) . up / |B - A|` in real metres (EQUATIONS, versines), positive when P lies
/// right of the chord: a left-hand curve of radius R has +L^2 / (8 R) at mid-chord. `up` is the ellipsoid's normal
/// at P; only horizontal components count.
[[nodiscard]] double horizontal_versine(const Eigen::Vector3d& P, const Eigen::Vector3d& A, const Eigen::Vector3d& B,
                                        const Eigen::Vector3d& up);

/// Horizontal versines of a rail given in ECEF, at each grid point P with the chord from `offset` before it.
/// NaN where the chord leaves the run or meets NaN.
[[nodiscard]] std::vector<double> horizontal_versines(std::span<const Eigen::Vector3d> rail_ecef, double step,
                                                      const Chord& chord);
/// Versines of any scalar along the grid (heights, deviations): e(P) minus the chord's straight line there.
[[nodiscard]] std::vector<double> scalar_versines(std::span<const double> e, double step, const Chord& chord);

/// The chord check at each grid point P = P_first, from deviations from design.
[[nodiscard]] std::vector<double> chord_check(std::span<const double> e, double step, const ChordCheck& check);
/// The value largest in magnitude among all chords that hold both P and P + distance: the worst phase.
[[nodiscard]] std::vector<double> chord_check_worst(std::span<const double> e, double step, const ChordCheck& check);

/// Gain of a check at a wavelength, for its own phase: |1 - exp(i a d) + d/L (exp(i a (L - f)) - exp(-i a f))|.
[[nodiscard]] double chord_check_gain(const ChordCheck& check, double wavelength);

/// Value on the grid at a (not necessarily whole) index; NaN outside.
[[nodiscard]] double grid_value(std::span<const double> x, double index);

}  // namespace versine::track
