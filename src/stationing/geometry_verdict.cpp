// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/geometry_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/core/units.hpp"

namespace versine::stationing {
namespace {

double largest_gap(std::span<const Eigen::Vector3d> lines) {
  std::vector<double> azimuth;
  for (const auto& l : lines) azimuth.push_back(std::atan2(l.y(), l.x()));
  std::sort(azimuth.begin(), azimuth.end());
  double gap = 2.0 * std::numbers::pi - (azimuth.back() - azimuth.front());
  for (std::size_t i = 1; i < azimuth.size(); ++i) gap = std::max(gap, azimuth[i] - azimuth[i - 1]);
  return gap;
}

}  // namespace

GeometryVerdict judge_geometry(std::span<const Eigen::Vector3d> lines, const StationResult& result,
                               double wanted_sigma) {
  using Grade = GeometryVerdict::Grade;
  GeometryVerdict v;
  const auto remark = [&](Grade grade, std::string text) {
    v.grade = std::max(v.grade, grade);
    v.remarks.push_back(std::move(text));
  };
  v.largest_gap = largest_gap(lines);
  if (lines.size() < 4)
    remark(Grade::weak, fmt::format("only {} back-sights: a blunder can be seen, not found", lines.size()));
  const double spread = (2.0 * std::numbers::pi - v.largest_gap) / units::deg;
  if (spread < 60.0) {
    remark(Grade::poor, fmt::format("all back-sights within {:.0f} deg", spread));
  } else if (spread < 170.0) {
    remark(Grade::weak, fmt::format("all back-sights on one side, within {:.0f} deg", spread));
  }
  double farthest = 0.0;
  for (const auto& l : lines) farthest = std::max(farthest, l.norm());
  if (farthest < 15.0)
    remark(Grade::weak, fmt::format("all back-sights nearer than {:.0f} m: attitude is weak", farthest));
  for (const TargetResult& t : result.targets) {
    if (t.redundancy.minCoeff() < 0.05 && result.redundancy > 0) {
      remark(Grade::weak, fmt::format("nothing checks {}: a blunder there goes into the position", t.point));
    }
  }
  const double sigma = std::sqrt(result.covariance.diagonal().head<3>().maxCoeff());
  if (sigma > wanted_sigma) {
    remark(Grade::poor, fmt::format("position sigma {:.2f} mm, wanted {:.2f} mm", sigma * 1e3, wanted_sigma * 1e3));
  }
  return v;
}

}  // namespace versine::stationing
