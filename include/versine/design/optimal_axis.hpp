// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "versine/design/alignment.hpp"

namespace versine::design {

/// Where the track axis was measured.
struct TrackSample {
  double distance = 0.0;  ///< along the run, m, increasing
  double easting = 0.0;   ///< m
  double northing = 0.0;  ///< m
  double heading = 0.0;   ///< of the track, rad from grid north clockwise, from the smoothed attitude
  double height = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN: no profile is wanted
  double cant = std::numeric_limits<double>::quiet_NaN();    ///< m, positive: left rail higher; NaN: none is wanted
};

struct OptimalAxisOptions {
  double step = 2.0;       ///< m between the samples that are used
  double cell = 5.0;       ///< m, of the curvature diagram that is segmented
  double shortest = 10.0;  ///< m; shorter lines, arcs and transitions are not looked for
  double straight = 20e3;  ///< m; a larger radius is tried as a straight, and stays one when it fits as well
  std::vector<Shape> shapes = {Shape::clothoid, Shape::bloss};  ///< transitions that may occur; the first is the usual
  double huber = 3.0;         ///< offsets beyond so many standard deviations count linearly
  double round_radius = 0.0;  ///< m; radii are rounded to multiples and the rest is fitted again; 0: not
  double round_length = 0.0;  ///< m; the same for lengths of transitions
};

/// Standard deviations of what was fitted for one horizontal element. Zero: not estimated (rounded, or given).
struct ElementSigma {
  double joint = 0.0;      ///< of the distance of its start, m
  double length = 0.0;     ///< m
  double curvature = 0.0;  ///< of a line or arc, 1/m; of its radius: curvature * R^2
  double cant = 0.0;       ///< of the cant of a line or arc, m
  /// Of a transition: its kind (clothoid, Bloss, ...) is told by the data. Otherwise the usual kind was taken; another
  /// kind with another length would describe the track as well.
  bool kind_certain = false;
};

/// Standard deviations of one gradient of the profile and of the curve at its start.
struct GradientSigma {
  double gradient = 0.0;  ///< ratio
  double place = 0.0;     ///< of the intersection at its start, m; 0 at the start of the profile
  double curve = 0.0;     ///< of the length of the parabola there, m
};

/// An alignment that describes the measured track best.
struct OptimalAxis {
  Alignment alignment;
  std::vector<ElementSigma> sigma;            ///< one per horizontal element
  std::vector<GradientSigma> gradient_sigma;  ///< one per gradient; empty without heights
  Eigen::MatrixXd covariance;  ///< of the unknowns: offset and heading at the start, then lengths and curvatures
  std::vector<std::string> unknowns;
  double offset_rms = 0.0;   ///< of the samples against the axis, m
  double heading_rms = 0.0;  ///< rad
  double height_rms = std::numeric_limits<double>::quiet_NaN();
  double cant_rms = std::numeric_limits<double>::quiet_NaN();
  std::size_t outliers = 0;  ///< samples beyond `huber`
};

/// The alignment of a track without a design (issue: optimal axis). The curvature diagram (heading against distance) is
/// split by `segment`; lines, arcs and transitions in between form one chain, without gap or kink by construction,
/// whose start, lengths and curvatures are fitted in one least-squares solve (Ceres) to the offsets across the axis and
/// to the headings, with Huber's weights. Kinds of transition are chosen by their residuals. Elements that the data do
/// not need are dropped. The covariance takes the correlation of the residuals along the track into account
/// (heteroscedasticity and autocorrelation consistent, Newey and West 1987). Cant is fitted with ramps tied to the
/// transitions; the profile is fitted as gradients and parabolas.
/// Fails when there are fewer than 20 samples or less than 50 m, or numbers that are not finite.
[[nodiscard]] Expected<OptimalAxis> optimal_axis(std::span<const TrackSample> samples,
                                                 const OptimalAxisOptions& options = {});

}  // namespace versine::design
