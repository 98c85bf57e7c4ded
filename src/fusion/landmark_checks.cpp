// SPDX-License-Identifier: Apache-2.0
#include "landmark_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace versine::fusion::landmark {

Expected<void> check_input(const LandmarkInput& in, const LandmarkOptions& o) {
  if (in.imu == nullptr || in.imu->size() < 2) {
    return fail({.field = "imu",
                 .found = "no samples",
                 .expected = "gyro increments over the whole run",
                 .advice = "name the IMU's file in the job"});
  }
  if (in.odometer == nullptr || in.odometer->size() < 2) {
    return fail(
        {.field = "odometer",
         .found = "no odometer",
         .expected = "distances over the whole run",
         .advice = "landmark dead reckoning needs an odometer: name its file in the job, or use the aided INS"});
  }
  if (in.landmarks == nullptr || in.landmarks->size() < 2) {
    return fail(
        {.field = "landmarks",
         .found = fmt::format("{} landmarks", in.landmarks == nullptr ? 0 : in.landmarks->size()),
         .expected = "at least two positions at which the trolley stood",
         .advice = "one at each end of the line fixes position, heading and odometer scale; better every 60 m"});
  }
  const double positive[] = {o.gyro.random_walk, o.pitch_sigma,   o.levelling_sigma,
                             o.scale_sigma,      o.node_interval, o.gate};
  for (const double x : positive) {
    if (!(x > 0.0)) {
      return fail({.field = "landmark options",
                   .found = "a standard deviation or interval that is not positive",
                   .expected = "gyro random walk, pitch, levelling, scale, node interval and gate above zero",
                   .advice = "choose a gyro grade, or give each value"});
    }
  }
  for (const auto& l : *in.landmarks) {
    if (!(l.covariance.diagonal().minCoeff() > 0.0)) {
      return fail({.field = "landmarks",
                   .found = fmt::format("landmark '{}' with a sigma that is not positive", l.name),
                   .expected = "a sigma above zero in each direction",
                   .advice = "give the instrument's, such as 0.6 mm"});
    }
  }
  return {};
}

namespace {

/// The odometer's distance at a time, as the sample at or before it says.
double distance_at(const Series<sensors::OdometerSample>& odometer, Time t) {
  const std::size_t i = odometer.lower_bound(t);
  if (i == odometer.size()) return odometer.back().distance;
  if (i == 0 || odometer[i].time == t) return odometer[i].distance;
  const auto &a = odometer[i - 1], &b = odometer[i];
  return a.distance + (b.distance - a.distance) * (t - a.time).seconds() / (b.time - a.time).seconds();
}

}  // namespace

Expected<std::vector<std::size_t>> usable_landmarks(const LandmarkInput& in, const LandmarkOptions& o, Time start,
                                                    RunRecord& record) {
  std::vector<std::size_t> usable;
  Error moving;
  const Time end = std::min(in.imu->back().time, in.odometer->back().time);
  for (std::size_t i = 0; i < in.landmarks->size(); ++i) {
    const auto& l = (*in.landmarks)[i];
    if (l.time < in.imu->front().time || l.time > end) {
      record.rejections.push_back({.sensor = "landmark", .time = l.time, .reason = "outside the recording"});
      continue;
    }
    // Without a standstill given, half a second on either side has to be quiet.
    const Duration half = Duration::from_seconds(0.5);
    const Time from = l.from < l.to ? l.from : l.time - half, to = l.from < l.to ? l.to : l.time + half;
    const double moved = std::abs(distance_at(*in.odometer, to) - distance_at(*in.odometer, from));
    const double since =
        l.time < start ? std::abs(distance_at(*in.odometer, start) - distance_at(*in.odometer, l.time)) : 0.0;
    if (std::max(moved, since) <= o.standing_tolerance + o.odometer_resolution) {
      usable.push_back(i);
      continue;
    }
    record.rejections.push_back({.sensor = "landmark", .time = l.time, .reason = "not standing"});
    moving = {.field = "landmarks",
              .found = fmt::format("landmark '{}' at {:.3f} s while the odometer moved {:.1f} mm", l.name,
                                   l.time.seconds(), std::max(moved, since) / units::mm),
              .expected = fmt::format("a trolley that stands to {:.1f} mm", o.standing_tolerance / units::mm),
              .advice =
                  "check the clocks of odometer and total station against each other and the landmark's from and "
                  "to; or leave out landmarks taken in motion (skip_moving_landmarks = true)"};
    if (!o.skip_moving_landmarks) return fail(moving);
  }
  if (usable.size() < 2) {
    if (!moving.found.empty()) return fail(moving);
    return fail({.field = "landmarks",
                 .found = fmt::format("{} of {} landmarks within the recording", usable.size(), in.landmarks->size()),
                 .expected = "at least two",
                 .advice = "check the landmarks' clock and day against the IMU's"});
  }
  return usable;
}

}  // namespace versine::fusion::landmark
