// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

/// From samples at irregular mileages to a grid. `s` increases strictly; a grid point inside a gap between samples
/// that is longer than `max_gap`, or outside them, gets NaN.
namespace versine::track {

/// Mean of the broken line through the samples over `window` around each grid point (exact integral, so that speed
/// does not matter). Frequency response: `moving_average_gain`. At the ends the window is cut off.
[[nodiscard]] std::vector<double> moving_average(std::span<const double> s, std::span<const double> x,
                                                 std::span<const double> at, double window, double max_gap);
/// sin(pi w / wavelength) / (pi w / wavelength).
[[nodiscard]] double moving_average_gain(double window, double wavelength);

/// Median of the samples within `window` around each sample: takes out rail joints and single wild readings, leaves
/// edges and trends. Not linear, so it has no frequency response; features shorter than half the window vanish.
[[nodiscard]] std::vector<double> median_filter(std::span<const double> s, std::span<const double> x, double window);

/// A fitted point.
struct FitPoint {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();  ///< NaN inside a gap
  double sigma = 0.0;       ///< of r in the horizontal plane, per axis, from the residuals (white part only), m
  int samples = 0;          ///< that carried weight
  double half_width = 0.0;  ///< that was used; larger than asked for where samples are sparse
};

/// Robust moving least squares (Chen 2018 section 4.4, after its ref. 27): at each grid point a parabola in mileage is
/// fitted to the points within `half_width`, all coordinates with the same weights: tricube in distance, bisquare in
/// the horizontal residual (first two coordinates), so that a bad sample is bad in easting and northing alike. Each
/// sample counts for the distance it stands for. Frequency response: `fit_gain`.
[[nodiscard]] std::vector<FitPoint> fit_moving(std::span<const double> s, std::span<const Eigen::Vector3d> r,
                                               std::span<const double> at, double half_width, double max_gap);
/// What a sine of amplitude 1 leaves the fit with, for dense samples: flat to the fourth order.
[[nodiscard]] double fit_gain(double half_width, double wavelength);

/// Value of the broken line through the samples; NaN outside and in gaps.
[[nodiscard]] std::vector<double> interpolated(std::span<const double> s, std::span<const double> x,
                                               std::span<const double> at, double max_gap);

}  // namespace versine::track
