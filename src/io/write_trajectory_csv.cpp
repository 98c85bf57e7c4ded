// SPDX-License-Identifier: Apache-2.0
#include "text_output.hpp"
#include "trajectory_columns.hpp"
#include "versine/core/calendar.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::io {

namespace {
const char* epoch_of(TimeScale scale) {
  switch (scale) {
    case TimeScale::gps:
      return "GPS time, s since 1980-01-06";
    case TimeScale::utc:
      return "UTC, s since 1970-01-01 without leap seconds";
    case TimeScale::recorder:
      return "recorder's own clock";
  }
  return "";
}
}  // namespace

Expected<void> write_trajectory_csv(const std::filesystem::path& path, const geodesy::Trajectory& trajectory,
                                    const TrajectoryOutput& output) {
  TextOutput out(path);
  const auto columns = trajectory_columns(output.projection != nullptr);
  out.print("# {}; time_s: {}; positions: WGS84, height above the ellipsoid\n", trajectory.origin,
            epoch_of(trajectory.scale));
  if (output.projection != nullptr) out.print("# easting, northing: {}\n", output.projection->definition());
  out.text("time_s");
  for (const TrajectoryColumn& column : columns) out.print(",{}", column.name);
  out.end_line();
  for (const std::size_t i : decimated(trajectory, output.interval)) {
    const geodesy::TrajectoryPoint& point = trajectory[i];
    const PointView view = view_of(point, output.projection);
    out.text(seconds_text(point.time));
    for (const TrajectoryColumn& column : columns) {
      out.text(",");
      out.number(column.value(point, view), column.decimals);
    }
    out.end_line();
  }
  return out.close();
}

Expected<void> write_innovations_csv(const std::filesystem::path& path, std::span<const fusion::Innovation> innovations,
                                     TimeScale) {
  TextOutput out(path);
  out.text("time_s,sensor,component,innovation,sigma,nis,used\n");
  for (const fusion::Innovation& innovation : innovations) {
    for (Eigen::Index k = 0; k < innovation.value.size(); ++k) {
      out.print("{},{},{},{:.7g},{:.7g},{:.6g},{}\n", seconds_text(innovation.time), innovation.sensor, k,
                innovation.value[k], innovation.sigma[k], innovation.nis, innovation.used ? 1 : 0);
    }
  }
  return out.close();
}

Expected<void> write_rejections_csv(const std::filesystem::path& path, std::span<const Rejection> rejections,
                                    TimeScale) {
  TextOutput out(path);
  out.text("time_s,sensor,reason,normalized,threshold\n");
  for (const Rejection& rejection : rejections) {
    out.print("{},{},{},", seconds_text(rejection.time), rejection.sensor, rejection.reason);
    out.number(rejection.normalized, 3);
    out.text(",");
    out.number(rejection.threshold, 3);
    out.end_line();
  }
  return out.close();
}

}  // namespace versine::io
