// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "versine/fusion/ins_state.hpp"
#include "versine/inertial/mechanization.hpp"

namespace versine::fusion::detail {

/// Carries a state along the IMU to any time, cutting the samples' intervals where needed. Deterministic: the output
/// pass walks the same way as the filter and so needs no state but that at the steps' starts.
class ImuWalk {
 public:
  /// `next`: the first sample that ends after the state's time; `begin`: the segment's first sample.
  ImuWalk(const sensors::ImuSeries& imu, std::size_t begin, std::size_t next) : imu_(imu), begin_(begin), next_(next) {}

  [[nodiscard]] std::size_t next() const { return next_; }

  /// Moves `nav` (with C_nb beside it) to `until`; `each(geometry, increment, nav)` sees every piece. `hold`: the
  /// vehicle stands, its position stays.
  template <class Each>
  void advance(inertial::NavState& nav, Eigen::Matrix3d& C_nb, const inertial::ImuCorrection& correction, Time until,
               bool hold, Each&& each) {
    while (nav.time < until) {
      const Time sample_end = imu_[next_].time;
      const inertial::Increment whole = increment(next_, correction);
      const Time end = std::min(sample_end, until);
      const inertial::Increment piece = inertial::part(whole, (end - nav.time).seconds() / whole.dt);
      inertial::StepGeometry geometry;
      const geodesy::Geodetic place = nav.position;
      nav = inertial::mechanize(nav, piece, geodesy::wgs84, C_nb, geometry);
      if (hold) nav.position = place;
      nav.time = end;
      each(geometry, piece, nav);
      if (end == sample_end) ++next_;
    }
  }

 private:
  [[nodiscard]] double interval(std::size_t i) const {
    return (i > begin_ ? imu_[i].time - imu_[i - 1].time : imu_.interval).seconds();
  }
  [[nodiscard]] inertial::Increment increment(std::size_t i, const inertial::ImuCorrection& correction) const {
    const inertial::Increment now = inertial::corrected(imu_[i], interval(i), correction);
    if (i == begin_) return now;
    return inertial::with_coning_and_sculling(inertial::corrected(imu_[i - 1], interval(i - 1), correction), now);
  }

  const sensors::ImuSeries& imu_;
  std::size_t begin_, next_;
};

}  // namespace versine::fusion::detail
