// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/filter/error_chain.hpp"
#include "versine/geodesy/project_map.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/sensors/measurements.hpp"
#include "versine/track/geometry.hpp"
#include "versine/track/trolley.hpp"

namespace versine::design {
struct Alignment;
}

namespace versine::track {

/// A point of known mileage that the run passed: a kilometre post, a joint, a start or an end.
struct MileageMark {
  Time time;             ///< when the trolley's beam was beside it
  double mileage = 0.0;  ///< continuous, m
};

/// What geometry is computed from. The trajectory may come from any method or file; everything else is optional.
struct GeometryInput {
  const geodesy::Trajectory* trajectory = nullptr;  ///< of the IMU's reference point, with the IMU's attitude
  const filter::ErrorChain* chain = nullptr;        ///< joint errors; without it relative values have no sigma
  Series<sensors::GaugeSample> gauge;
  Series<sensors::RangeSample> range;
  std::vector<Series<sensors::OdometerSample>> odometers;
  std::vector<MileageMark> marks;
  const design::Alignment* design = nullptr;      ///< mileage, deviations and cant refer to it
  std::optional<geodesy::Projection> projection;  ///< of coordinates; default: the UTM zone of the start
  std::optional<geodesy::Similarity> similarity;  ///< from there to the project's own grid, which the design is in
  geodesy::HeightDatum heights;                   ///< of the project, against the trajectory's
  /// Added to all heights, m, and the name of their datum.
  double height_offset = 0.0;
  std::string height_datum = "ellipsoidal";
  Trolley trolley;
};

/// The map that the result is in: what the input names, else the design's, else the UTM zone of the start. Fails when
/// there is a design of unknown coordinate system.
[[nodiscard]] Expected<geodesy::ProjectMap> map_of(const GeometryInput& input);

/// A versine measured at `offset` from the chord's start; the mid-chord when offset = length / 2.
struct Chord {
  double length = 10.0;  ///< m
  double offset = 5.0;   ///< m from the start of the chord, in the direction of mileage
};

/// Difference of two versine deviations on one chord (EQUATIONS, "30 m and 300 m check"):
/// `(e(first) - e(first + distance)) + distance / length * (e(length) - e(0))`, e the deviation from design.
struct ChordCheck {
  std::string name = "30m";
  double length = 30.0;   ///< chord, m
  double first = 15.0;    ///< first point from the chord's start, m
  double distance = 5.0;  ///< between the two points, m
};

/// A wavelength band of EN 13848-1, filtered by a Butterworth band-pass, forward and backward (no phase shift).
struct Band {
  std::string name = "d1";
  double shortest = 3.0;  ///< wavelength at the upper edge, m
  double longest = 25.0;  ///< wavelength at the lower edge, m
};

enum class RailPoint { gauge_corner, head_centre };
enum class Travel { increasing, decreasing };       ///< mileage along the trolley's x axis, without design and marks
enum class MileageSource { trajectory, odometer };  ///< without design
enum class HeightReference { low_rail, axis };      ///< what the design's heights belong to where there is cant

struct GeometryOptions {
  double step = 0.25;            ///< of the result, m
  double fit_half_width = 0.5;   ///< of the moving least squares in easting and northing, m
  double average_window = 0.25;  ///< of the moving average of heights, cross level and gauge, m
  RailPoint rail_point = RailPoint::gauge_corner;
  double nominal_gauge = 1.435;  ///< m, where the design tells none
  double rail_distance = 1.5;    ///< hypotenuse of the cross level: distance of the head centres, m
  double gauge_median = 0.15;    ///< window of the median filter against rail joints, m
  double curvature_base = 20.0;  ///< over which curvature and gradient are formed, m
  std::vector<double> twist_bases = {3.0};
  std::vector<Chord> chords = {{10.0, 5.0}, {20.0, 10.0}};
  std::vector<ChordCheck> checks = {{"30m", 30.0, 15.0, 5.0}, {"300m", 300.0, 15.0, 150.0}};
  std::vector<Band> bands = {{"d1", 3.0, 25.0}, {"d2", 25.0, 70.0}};
  int filter_order = 4;  ///< of the low-pass prototype of the bands, see band_pass
  Travel travel = Travel::increasing;
  MileageSource mileage_source = MileageSource::trajectory;
  HeightReference height_reference = HeightReference::low_rail;
  double max_gap = 1.0;        ///< between samples that are joined by interpolation, m
  double start_mileage = 0.0;  ///< without design and marks, m
  double max_offset = 5.0;     ///< from the design axis, beyond which a point is off the design, m
};

/// Track geometry of a run. A rail's point has the lateral place of its gauge corner (or head centre) in the plane of
/// the running surfaces, and the height of its head centre, rail_distance apart, so that the heights differ by the
/// cross level exactly. Without design, deviations and chord checks are absent and alignment is band-filtered from the
/// rails' curvature. Relative values get their sigma from `chain`. Pure; linear in the length of the run.
/// Fails when the run and the design do not meet, when the trajectory is empty or does not move, or when marks
/// contradict the direction of travel; everything else that is wrong is flagged in the result and told in its record.
[[nodiscard]] Expected<Geometry> compute_geometry(const GeometryInput& input, const GeometryOptions& options,
                                                  Progress& progress);

}  // namespace versine::track
