// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>

#include "versine/core/numbers.hpp"
#include "versine/design/alignment.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/track/compute.hpp"

/// An exact run of a trolley over a track whose centre, roll and gauge are given functions of mileage: the poses follow
/// from the three contact points, without any of the code under test.
namespace versine::track::test {

/// Straight, clothoid, right-hand arc of 800 m with 100 mm cant, clothoid, straight; gradient 8 per mille.
inline design::Alignment example_line() {
  using namespace design;
  return {.horizontal = *HorizontalAxis::chain({560000.0, 5600000.0, 0.7},
                                               {line(400), transition(Shape::clothoid, 100, inf, 800), arc(300, 800),
                                                transition(Shape::clothoid, 100, 800, inf), line(600)}),
          .profile = Profile::constant(0.0, 120.0, 0.008, 1500.0),
          .cant = *CantProfile::from_points({{0, 0}, {400, 0}, {500, 0.1}, {800, 0.1}, {900, 0}, {1500, 0}}),
          .chainage = {},
          .name = "example",
          .crs = "EPSG:25832"};
}

struct Track {
  design::Alignment design = example_line();
  std::function<double(double)> lateral = [](double) { return 0.0; };   ///< of the axis, right, m
  std::function<double(double)> vertical = [](double) { return 0.0; };  ///< of the axis, up, m
  std::function<double(double)> gauge = [](double) { return 1.435; };   ///< m
  std::function<double(double)> cross = [](double) { return 0.0; };     ///< added to the design cant, m
};

struct Run {
  geodesy::Trajectory trajectory;
  Series<sensors::GaugeSample> gauge;
  Trolley trolley;
};

struct Corners {
  Eigen::Vector3d left, right;  // in the local frame, m
};

class Builder {
 public:
  Builder(const Track& track, const geodesy::Projection& projection)
      : track_(track),
        projection_(projection),
        scale_(1.0),
        frame_(projection.inverse({track.design.at(0).easting, track.design.at(0).northing, 0.0})) {
    scale_ = projection.distortion(frame_.origin()).scale / (1.0 + 120.0 / 6.38e6);  // metres at the track's height
  }

  [[nodiscard]] Corners corners(double s) const {
    const design::DesignPoint p = track_.design.at(s);
    const double roll = std::asin(((std::isfinite(p.cant) ? p.cant : 0.0) + track_.cross(s)) / 1.5);
    const double h = (std::isfinite(p.height) ? p.height : 0.0) + track_.vertical(s);
    const auto at = [&](double offset, double height) {
      const double d = offset * scale_;
      const geodesy::MapPoint m{p.easting + d * std::cos(p.heading), p.northing - d * std::sin(p.heading), height};
      return frame_.to_ned(projection_.inverse(m));
    };
    const double half = 0.5 * track_.gauge(s);
    return {at(track_.lateral(s) - half * std::cos(roll), h + half * std::sin(roll)),
            at(track_.lateral(s) + half * std::cos(roll), h - half * std::sin(roll))};
  }

  /// `direction`: of the trolley's x axis; `travel`: the way it is pushed in mileage.
  [[nodiscard]] Run run(double from, double to, double spacing, double direction = 1.0, double travel = 1.0) const {
    Run out;
    const Trolley& t = out.trolley;
    const int n = static_cast<int>(std::floor((to - from) / spacing));
    for (int k = 0; k <= n; ++k) {
      const double s = travel > 0 ? from + k * spacing : to - k * spacing;
      const bool left = direction > 0;
      const auto pick = [&](double at, bool want_left) {
        const Corners c = corners(at);
        return want_left ? c.left : c.right;
      };
      const Eigen::Vector3d a1 = pick(s + direction * t.front_x, left), a2 = pick(s + direction * t.rear_x, left);
      const Eigen::Vector3d a3 = pick(s, !left);
      const Eigen::Vector3d x = (a1 - a2).normalized();
      const Eigen::Vector3d z = x.cross(a3 - a2).normalized(), y = z.cross(x);  // A3 is to the right of x
      Eigen::Matrix3d C;
      C << x, y, z;
      const Eigen::Vector3d imu = 0.5 * (a1 + a2) - C * Eigen::Vector3d(0.0, t.reference_y, t.contact_z);
      geodesy::TrajectoryPoint p;
      p.time = Time{k * 100'000'000LL};
      p.position = frame_.to_geodetic(imu);
      p.q_nb = Eigen::Quaterniond(frame_.rotation_from(p.position).transpose() * C);
      out.trajectory.samples.push_back(p);
      out.gauge.samples.push_back({p.time, (a3 - a2).dot(y) - t.gauge_offset, 20.0});
    }
    out.trajectory.origin = "test";
    return out;
  }

  [[nodiscard]] const geodesy::LocalFrame& frame() const { return frame_; }

 private:
  const Track& track_;
  const geodesy::Projection& projection_;
  double scale_;
  geodesy::LocalFrame frame_;
};

}  // namespace versine::track::test
