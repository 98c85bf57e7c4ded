// SPDX-License-Identifier: Apache-2.0
#include "versine/io/write_positions.hpp"

#include <cmath>

#include "text_output.hpp"
#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {
int rtklib_quality(sensors::FixType fix) {
  switch (fix) {
    case sensors::FixType::fixed:
      return 1;
    case sensors::FixType::float_ambiguity:
      return 2;
    case sensors::FixType::differential:
      return 4;
    default:
      return 5;
  }
}
}  // namespace

Expected<void> write_gnss_csv(const std::filesystem::path& path, const Series<sensors::GnssSample>& gnss) {
  const bool velocity = !gnss.empty() && gnss.front().v_ned.has_value();
  TextOutput out(path);
  out.text(std::string("time_s,latitude_deg,longitude_deg,height_m,sigma_north_m,sigma_east_m,sigma_down_m,"
                       "fix_rtklib,satellites,ratio") +
           (velocity ? ",velocity_north_mps,velocity_east_mps,velocity_down_mps,"
                       "sigma_velocity_north_mps,sigma_velocity_east_mps,sigma_velocity_down_mps"
                     : ""));
  out.end_line();
  for (const auto& s : gnss) {
    std::string more;
    if (velocity) {
      const Eigen::Vector3d v = s.v_ned.value_or(Eigen::Vector3d::Zero());
      more = fmt::format(",{:.5f},{:.5f},{:.5f},{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z(), s.sigma_v_ned.x(),
                         s.sigma_v_ned.y(), s.sigma_v_ned.z());
    }
    out.print("{},{:.11f},{:.11f},{:.5f},{:.5f},{:.5f},{:.5f},{},{},{:.1f}{}\n", seconds_text(s.time),
              s.position.latitude / units::deg, s.position.longitude / units::deg, s.position.height, s.sigma_ned.x(),
              s.sigma_ned.y(), s.sigma_ned.z(), rtklib_quality(s.fix), s.satellites, s.ratio, more);
  }
  return out.close();
}

Expected<void> write_landmarks_csv(const std::filesystem::path& path,
                                   const std::vector<sensors::LandmarkSample>& landmarks) {
  TextOutput out(path);
  out.text(
      "name,time_from_s,time_to_s,latitude_deg,longitude_deg,height_m,sigma_north_m,sigma_east_m,"
      "sigma_down_m");
  out.end_line();
  for (const auto& s : landmarks) {
    out.print("{},{},{},{:.12f},{:.12f},{:.6f},{:.6f},{:.6f},{:.6f}\n", s.name, seconds_text(s.from),
              seconds_text(s.to), s.position.latitude / units::deg, s.position.longitude / units::deg,
              s.position.height, std::sqrt(s.covariance(0, 0)), std::sqrt(s.covariance(1, 1)),
              std::sqrt(s.covariance(2, 2)));
  }
  return out.close();
}

}  // namespace versine::io
