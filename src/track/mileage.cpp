// SPDX-License-Identifier: Apache-2.0
#include "versine/track/mileage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "versine/core/numbers.hpp"
#include "versine/design/alignment.hpp"
#include "versine/design/axis_index.hpp"
#include "versine/track/local_map.hpp"
#include "versine/track/odometry.hpp"

namespace versine::track {
namespace {

/// Way of the trolley at each epoch, signed along its x axis, m (real metres, horizontal).
std::vector<double> way_along(const geodesy::Trajectory& trajectory, const Eigen::Matrix3d& C_bv) {
  std::vector<double> way(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector3d d = geodesy::wgs84.ned_difference(trajectory[i - 1].position, trajectory[i].position);
    const Eigen::Vector3d x = trajectory[i].q_nb * C_bv.col(0);
    way[i] = way[i - 1] + (d.x() * x.x() + d.y() * x.y()) / std::max(1e-9, std::hypot(x.x(), x.y()));
  }
  return way;
}

struct Anchor {
  std::size_t epoch;
  double mileage, offset;
};

/// Anchors every `every` metres of way: the trolley's middle projected onto the axis.
struct Projected {
  std::vector<Anchor> anchors;
  double direction = 1.0;
};

Projected project(const GeometryInput& input, const GeometryOptions& options, const geodesy::ProjectMap& projection,
                  const std::vector<double>& way, double every) {
  const geodesy::Trajectory& trajectory = *input.trajectory;
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(input.trolley.mounting).transpose();
  const Eigen::Vector3d centre = C_bv * beam_centre(input.trolley, options.nominal_gauge);
  std::vector<design::MapPosition> places;
  std::vector<std::size_t> epochs;
  std::optional<LocalMap> map;
  Eigen::Vector3d first_x = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (!epochs.empty() && std::abs(way[i] - way[epochs.back()]) < every && i + 1 < trajectory.size()) continue;
    const auto& p = trajectory[i];
    Eigen::Vector3d ned = map ? map->frame().to_ned(p.position) : Eigen::Vector3d::Zero();
    if (!map || ned.head<2>().norm() > LocalMap::reach - 5.0) {
      map.emplace(p.position, projection);
      ned.setZero();
    }
    const Eigen::Vector3d e = map->forward(ned + map->frame().rotation_from(p.position) * (p.q_nb * centre));
    if (!e.allFinite()) continue;
    if (epochs.empty()) first_x = e;
    places.push_back({e.x(), e.y()});
    epochs.push_back(i);
  }
  Projected out;
  const design::AxisIndex index(input.design->horizontal);
  const auto feet = design::project_run(index, places);
  double votes = 0.0;
  for (std::size_t k = 0; k < feet.size(); ++k) {
    const bool on = feet[k].inside && std::abs(feet[k].offset) <= options.max_offset;
    out.anchors.push_back({epochs[k], feet[k].distance, on ? feet[k].offset : nan});
    if (k > 0) votes += (feet[k].distance - feet[k - 1].distance) * (way[epochs[k]] - way[epochs[k - 1]]);
  }
  out.direction = votes >= 0.0 ? 1.0 : -1.0;
  return out;
}

Expected<std::vector<double>> along_marks(const GeometryInput& input, const GeometryOptions& options,
                                          const std::vector<double>& way, double& direction) {
  const geodesy::Trajectory& trajectory = *input.trajectory;
  const auto way_at = [&](Time t) {
    const std::size_t i = std::min(trajectory.lower_bound(t), trajectory.size() - 1);
    if (i == 0) return way[0];
    const double f = (t - trajectory[i - 1].time).seconds() / (trajectory[i].time - trajectory[i - 1].time).seconds();
    return way[i - 1] + std::clamp(f, 0.0, 1.0) * (way[i] - way[i - 1]);
  };
  std::vector<std::pair<double, double>> knots;  // way, mileage
  for (const MileageMark& m : input.marks) {
    if (m.time < trajectory.front().time || trajectory.back().time < m.time) continue;
    knots.emplace_back(way_at(m.time), m.mileage);
  }
  std::sort(knots.begin(), knots.end());
  direction = options.travel == Travel::decreasing ? -1.0 : 1.0;
  if (knots.size() > 1) direction = knots.back().second >= knots.front().second ? 1.0 : -1.0;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double d = knots[k].first - knots[k - 1].first, m = direction * (knots[k].second - knots[k - 1].second);
    if (!(m > 0.0) || std::abs(m / d - 1.0) > 0.02) {
      return fail({.field = "marks",
                   .found = fmt::format("mileage {:.3f} m follows {:.3f} m after {:.3f} m of way", knots[k].second,
                                        knots[k - 1].second, d),
                   .expected = "marks whose mileage goes one way and agrees with the way travelled within 2 %",
                   .advice = "correct the mark's mileage or time, or the odometer's scale"});
    }
  }
  if (knots.empty()) knots.emplace_back(way.front(), options.start_mileage);
  std::vector<double> mileage(way.size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    auto it = std::upper_bound(knots.begin(), knots.end(), std::make_pair(way[i], -1e300));
    auto b = std::min(static_cast<std::size_t>(it - knots.begin()), knots.size() - 1);
    if (b == 0 && knots.size() > 1) b = 1;
    const auto& right = knots[b];
    const auto& left = knots[b > 0 ? b - 1 : 0];
    const double scale = b > 0 ? (right.second - left.second) / (right.first - left.first) : direction;
    mileage[i] = left.second + scale * (way[i] - left.first);
  }
  return mileage;
}

/// Keeps the epochs that advance; what falls back is told.
void keep_advancing(const geodesy::Trajectory& trajectory, const std::vector<double>& mileage,
                    const std::vector<float>& offset, double travel, double spacing, RunMileage& out) {
  double top = -std::numeric_limits<double>::infinity(), low = top;
  std::size_t fallen_from = 0;
  bool fallen = false;
  for (std::size_t i = 0; i < mileage.size(); ++i) {
    const double m = travel * mileage[i];
    if (!std::isfinite(m)) continue;
    if (m >= top + spacing) {
      if (fallen && top - low > 0.2) {
        out.repeated.emplace_back(std::min(travel * low, travel * top), std::max(travel * low, travel * top));
        out.record.findings.push_back(
            {.sensor = "mileage",
             .kind = "backwards",
             .from = trajectory[fallen_from].time,
             .to = trajectory[i].time,
             .count = i - fallen_from,
             .action = Finding::Action::removed,
             .detail = fmt::format("{:.2f} m passed again; the first pass is used", top - low)});
      }
      fallen = false;
      top = m;
      out.epoch.push_back(static_cast<std::uint32_t>(i));
      out.mileage.push_back(mileage[i]);
      out.offset.push_back(offset.empty() ? std::numeric_limits<float>::quiet_NaN() : offset[i]);
    } else if (m < top - 0.2) {
      if (!fallen) {
        fallen_from = i;
        low = m;
      }
      fallen = true;
      low = std::min(low, m);
    }
  }
  if (travel < 0.0) {
    std::reverse(out.epoch.begin(), out.epoch.end());
    std::reverse(out.mileage.begin(), out.mileage.end());
    std::reverse(out.offset.begin(), out.offset.end());
  }
}

}  // namespace

Eigen::Vector3d beam_centre(const Trolley& t, double nominal_gauge) {
  return {t.other_x, t.reference_y - t.reference_side() * 0.5 * nominal_gauge, t.contact_z};
}

Expected<RunMileage> synchronise_mileage(const GeometryInput& input, const GeometryOptions& options,
                                         const geodesy::ProjectMap& projection, double spacing) {
  const geodesy::Trajectory& trajectory = *input.trajectory;
  RunMileage out;
  std::vector<double> way = way_along(trajectory, geodesy::to_matrix(input.trolley.mounting).transpose());
  std::vector<double> mileage;
  std::vector<float> offset;
  if (input.design != nullptr) {
    const Projected p = project(input, options, projection, way, 0.5 * options.step);
    std::size_t on = 0;
    for (const Anchor& a : p.anchors) on += std::isfinite(a.offset);
    if (on * 100 < p.anchors.size()) {
      return fail(
          {.field = "design",
           .found = fmt::format("{} of {} places of the run within {} m of the alignment '{}' ({:.0f} m long)", on,
                                p.anchors.size(), options.max_offset, input.design->name, input.design->length()),
           .expected = "an alignment that contains the run, in the same coordinate system",
           .advice = "check the crs of job and design, the track's number, or raise geometry.max_offset_m"});
    }
    if (on < p.anchors.size()) {
      out.record.warnings.push_back(
          fmt::format("{:.1f} % of the run lies off the design alignment: no deviations there",
                      100.0 * double(p.anchors.size() - on) / double(p.anchors.size())));
    }
    out.direction = p.direction;
    mileage.assign(way.size(), nan);
    offset.assign(way.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t k = 0; k + 1 < p.anchors.size(); ++k) {
      const Anchor &a = p.anchors[k], &b = p.anchors[k + 1];
      const double d = way[b.epoch] - way[a.epoch];
      for (std::size_t i = a.epoch; i <= b.epoch; ++i) {
        const double f = std::abs(d) > 1e-9 ? (way[i] - way[a.epoch]) / d : 0.0;
        mileage[i] = a.mileage + f * (b.mileage - a.mileage);
        offset[i] = static_cast<float>(a.offset + f * (b.offset - a.offset));
      }
    }
  } else {
    if (options.mileage_source == MileageSource::odometer) {
      OdometerOptions wheels;
      wheels.forward = geodesy::to_matrix(input.trolley.mounting).transpose().col(0);
      const auto [odometer, scale, sigma] = combine_odometers(input.odometers, &trajectory, wheels, out.record);
      if (odometer.size() < 2) {
        return fail({.field = "odometer",
                     .found = "no odometer recording",
                     .expected = "at least one odometer, for mileage = \"odometer\"",
                     .advice = "add [[odometer]] to the job or take mileage from the trajectory"});
      }
      out.record.warnings.push_back(
          fmt::format("odometers: scale {:.6f} by the trajectory's way, {:.6f} left of it", scale, sigma));
      for (std::size_t i = 0; i < way.size(); ++i) way[i] = distance_at(odometer, trajectory[i].time);
    }
    auto along = along_marks(input, options, way, out.direction);
    if (!along) return tl::unexpected(along.error());
    mileage = std::move(*along);
  }
  // The way the run goes in mileage: the trolley may be pushed either end first.
  double first = nan, last = nan;
  for (const double m : mileage) {
    if (!std::isfinite(m)) continue;
    if (std::isnan(first)) first = m;
    last = m;
  }
  keep_advancing(trajectory, mileage, offset, last >= first ? 1.0 : -1.0, spacing, out);
  if (out.mileage.size() < 4 || out.mileage.back() - out.mileage.front() < 4.0 * options.step) {
    return fail({.field = "trajectory",
                 .found = "a trolley that moves less than four steps of the result",
                 .expected = "a run along the track",
                 .advice = "check that the trajectory covers the run and geometry.step_m"});
  }
  return out;
}

}  // namespace versine::track
