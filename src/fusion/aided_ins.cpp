// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/aided_ins.hpp"

#include <fmt/format.h>

#include "run_segment.hpp"
#include "versine/core/units.hpp"

namespace versine::fusion {

namespace {
using detail::Previous;

Expected<void> check(const AidedInsInput& in, const AidedInsOptions& o) {
  if (in.imu.size() < 10 || !(in.imu.interval.ns > 0)) {
    return fail({.field = "imu",
                 .found = fmt::format("{} samples", in.imu.size()),
                 .expected = "an IMU recording",
                 .advice = "name the IMU's file in the job"});
  }
  const bool ordered = in.imu.strictly_increasing() && in.gnss.strictly_increasing() &&
                       in.odometer.strictly_increasing() && in.speed.strictly_increasing() &&
                       in.landmarks.strictly_increasing() && in.heading.strictly_increasing();
  if (!ordered) throw std::invalid_argument("run_aided_ins: series with strictly increasing times are required");
  if (!(o.covariance_rate > 0.0) || !(o.odometer_sigma > 0.0) || !(o.constraint_sigma > 0.0) ||
      !(o.zero_velocity_sigma > 0.0)) {
    throw std::invalid_argument("run_aided_ins: rates and sigmas must be positive");
  }
  for (const sensors::GnssSample& s : in.gnss.samples) {
    if (!(s.sigma_ned.minCoeff() > 0.0) && !(o.gnss_sigma_minimum > 0.0)) {
      return fail({.field = "gnss",
                   .found = fmt::format("a sigma of zero or less at {:.3f} s", s.time.seconds()),
                   .expected = "positive standard deviations",
                   .advice = "give gnss sigma minimum"});
    }
  }
  return {};
}

/// Dead reckoning (Chen 2018 section 4.3): the odometer's way along the smoothed attitude, from the smoothed start.
geodesy::Trajectory dead_reckon(const AidedInsInput& in, const AidedInsOptions& o, const Solution& solution) {
  geodesy::Trajectory out;
  out.scale = in.imu.scale;
  out.origin = "dead reckoning, smoothed attitude and odometer";
  const geodesy::Trajectory& t = solution.smoothed;
  const auto scale = [&](Time at) {
    const auto it = std::lower_bound(solution.sensor_errors.begin(), solution.sensor_errors.end(), at,
                                     [](const SensorErrorSample& s, Time x) { return s.time < x; });
    const InsLayout layout = InsLayout::from(o);
    const auto& s = it == solution.sensor_errors.end() ? solution.sensor_errors.back() : *it;
    return 1.0 + static_cast<double>(s.value[layout.odometer_scale.offset - layout.moving()]);
  };
  const auto distance = [&](Time at) {
    const std::size_t i = std::clamp<std::size_t>(in.odometer.lower_bound(at), 1, in.odometer.size() - 1);
    const auto &a = in.odometer[i - 1], &b = in.odometer[i];
    const double share = std::clamp((at - a.time).seconds() / (b.time - a.time).seconds(), 0.0, 1.0);
    return a.distance + share * (b.distance - a.distance);
  };
  const Eigen::Vector3d forward_b = geodesy::to_matrix(o.mounting).row(0).transpose();
  for (std::size_t i = 0; i < t.size(); ++i) {
    geodesy::TrajectoryPoint p = t[i];
    if (i > 0 && t[i].segment == t[i - 1].segment) {
      const double way = (distance(t[i].time) - distance(t[i - 1].time)) / scale(t[i].time);
      const Eigen::Quaterniond middle = t[i - 1].q_nb.slerp(0.5, t[i].q_nb);
      // The wheel moves forward; the IMU follows on its lever arm, which turns with the vehicle.
      const Eigen::Vector3d swing = t[i].q_nb * o.wheel_lever.l_b - t[i - 1].q_nb * o.wheel_lever.l_b;
      p.position = geodesy::wgs84.displaced(out.samples.back().position, middle * forward_b * way - swing);
    }
    out.samples.push_back(p);
  }
  return out;
}

/// The common layouts are known to the compiler.
auto run_of(const InsLayout& layout) {
  using detail::run_segment, filter::moving, filter::moving_with_path;
  constexpr int any = Eigen::Dynamic;
  const int n = layout.size();
  if (layout.path.enabled()) {
    return n == 25   ? &run_segment<25, moving_with_path>
           : n == 28 ? &run_segment<28, moving_with_path>
                     : &run_segment<any, moving_with_path>;
  }
  return n == 23   ? &run_segment<23, moving>
         : n == 25 ? &run_segment<25, moving>
         : n == 26 ? &run_segment<26, moving>
         : n == 29 ? &run_segment<29, moving>
                   : &run_segment<any, moving>;
}
}  // namespace

Expected<AidedInsResult> run_aided_ins(const AidedInsInput& input, const AidedInsOptions& options, Progress& progress,
                                       Log& log, RunWatch* watch) {
  if (const auto checked = check(input, options); !checked) return fail(checked.error());
  AidedInsResult result;
  const InsLayout layout = InsLayout::from(options, input.landmarks);
  result.solution.error_names.assign(layout.names.begin() + layout.moving(), layout.names.end());
  result.solution.smoothed.scale = result.solution.forward.scale = input.imu.scale;
  result.solution.smoothed.origin = "aided INS, smoothed";
  result.solution.forward.origin = "aided INS, forward";
  if (options.zero_velocity) {
    result.standstills =
        inertial::find_standstills({&input.imu, &input.odometer, &input.speed, &input.gnss}, options.standstill);
  }
  detail::Judge judge(options, result);
  const detail::RunContext context{input, options, layout, result.standstills, judge, result, progress, watch};
  std::optional<Previous> previous;
  std::int32_t number = 0;
  for (const detail::Segment& segment : detail::segments_of(input, options)) {
    const Expected<detail::Start> start =
        detail::start_of(segment, input, options, layout, result.standstills, previous);
    if (!start) return fail(start.error());
    log.info(fmt::format("segment {} from {:.3f} s to {:.3f} s: heading from {}, sigma {:.3f} deg", number + 1,
                         segment.from.seconds(), segment.to.seconds(), start->alignment.method,
                         start->alignment.sigma.z() / units::deg));
    Expected<Previous> left = run_of(layout)(context, segment, *start, number);
    if (!left) return fail(left.error());
    previous = std::move(*left);
    ++number;
  }
  if (number == 0) {
    return fail({.field = "imu",
                 .found = "no two samples without a gap between them",
                 .expected = "a continuous IMU",
                 .advice = "check the sampling interval and the unit of the time column"});
  }
  judge.finish();
  if (options.dead_reckoning && input.odometer.size() > 1 && !result.solution.sensor_errors.empty()) {
    result.dead_reckoned = dead_reckon(input, options, result.solution);
  }
  return result;
}

}  // namespace versine::fusion
