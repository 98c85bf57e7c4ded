// SPDX-License-Identifier: Apache-2.0
#include "versine/app/landmark_residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::app {

namespace {

/// Mileage where the trolley stood: of the grid points passed before and after, when they are neighbours.
std::optional<double> mileage_at(const track::Geometry* g, Time t) {
  if (g == nullptr) return {};
  std::optional<std::size_t> before, after;
  for (std::size_t i = 0; i < g->time.size(); ++i) {
    if (g->time[i] <= t && (!before || g->time[*before] < g->time[i])) before = i;
    if (g->time[i] >= t && (!after || g->time[i] < g->time[*after])) after = i;
  }
  if (!before || !after) return {};
  const double a = g->mileage[*before], b = g->mileage[*after];
  if (std::abs(a - b) > 4.0 * g->step) return {};
  return 0.5 * (a + b);
}

bool rejected(const std::vector<fusion::Innovation>& innovations, Time t) {
  return std::any_of(innovations.begin(), innovations.end(), [t](const fusion::Innovation& i) {
    return !i.used && i.time == t && i.sensor.starts_with("landmark");
  });
}

Eigen::Vector3d up(const Eigen::Vector3d& ned) {
  return {ned.x(), ned.y(), -ned.z()};
}

/// Quotes only where a comma or a quote asks for it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::vector<LandmarkResidual> landmark_residuals(const Series<sensors::LandmarkSample>& landmarks,
                                                 const fusion::Solution& solution, const Eigen::Vector3d& lever_arm_b,
                                                 const track::Geometry* geometry) {
  std::vector<LandmarkResidual> out;
  const geodesy::Trajectory& track = solution.smoothed;
  for (const sensors::LandmarkSample& s : landmarks) {
    const std::size_t i = track.lower_bound(s.time);
    if (i == 0 || i >= track.size() || track[i].segment != track[i - 1].segment) continue;
    const auto &a = track[i - 1], &b = track[i];
    if (b.time - a.time > Duration::from_seconds(1.0)) continue;
    const double f = (s.time - a.time).seconds() / (b.time - a.time).seconds();
    const Eigen::Vector3d place =
        f * geodesy::wgs84.ned_difference(a.position, b.position) + a.q_nb.slerp(f, b.q_nb) * lever_arm_b;
    LandmarkResidual r{.name = s.name, .time = s.time, .mileage = mileage_at(geometry, s.time)};
    r.residual = up(geodesy::wgs84.ned_difference(a.position, s.position) - place);
    r.sigma_landmark = s.covariance.diagonal().cwiseSqrt();
    r.sigma_trajectory = (f < 0.5 ? a : b).position_covariance.matrix().diagonal().cwiseSqrt();
    r.used = !rejected(solution.innovations, s.time);
    out.push_back(std::move(r));
  }
  return out;
}

Expected<void> write_landmark_residuals(const std::filesystem::path& path,
                                        const std::vector<LandmarkResidual>& residuals,
                                        const track::Geometry* geometry) {
  std::string csv = "name,time_s,distance_m,mileage_m,used";
  for (const char* what : {"residual", "sigma_landmark", "sigma_trajectory"}) {
    csv += fmt::format(",{0}_north_mm,{0}_east_mm,{0}_up_mm", what);
  }
  csv += "\n";
  for (const LandmarkResidual& r : residuals) {
    csv += fmt::format("{},{:.3f},", field(r.name), r.time.seconds());
    csv += r.mileage ? fmt::format("{:.2f},{:.2f}", *r.mileage, geometry->posted_at(*r.mileage)) : std::string(",");
    csv += r.used ? ",1" : ",0";
    for (const Eigen::Vector3d* v : {&r.residual, &r.sigma_landmark, &r.sigma_trajectory}) {
      csv += fmt::format(",{:.3f},{:.3f},{:.3f}", 1e3 * v->x(), 1e3 * v->y(), 1e3 * v->z());
    }
    csv += "\n";
  }
  std::ofstream file(path, std::ios::binary);
  if (file << csv && file.flush()) return {};
  return fail({.file = path.string(),
               .found = "that it cannot be written",
               .expected = "a writable place with free space",
               .advice = "check permissions and free space"});
}

}  // namespace versine::app
