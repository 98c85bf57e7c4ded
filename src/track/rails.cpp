// SPDX-License-Identifier: Apache-2.0
#include "versine/track/rails.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "versine/core/numbers.hpp"
#include "versine/track/local_map.hpp"
#include "versine/track/resampling.hpp"

namespace versine::track {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Gauge readings by mileage, increasing.
struct GaugeLine {
  std::vector<double> s, value;
};

GaugeLine gauge_by_mileage(const GeometryInput& input, const GeometryOptions& options, const RunMileage& run) {
  const Trolley& t = input.trolley;
  GaugeLine out;
  if (input.gauge.empty()) return out;
  // Kept epochs in order of time carry the mileage; readings between two of them are interpolated.
  const bool reversed = run.epoch.front() > run.epoch.back();
  std::size_t k = 0;
  const auto index = [&](std::size_t i) { return reversed ? run.epoch.size() - 1 - i : i; };
  for (const auto& g : input.gauge) {
    if (!std::isfinite(g.reading) || !std::isfinite(g.temperature)) continue;
    while (k + 2 < run.epoch.size() && (*input.trajectory)[run.epoch[index(k + 1)]].time <= g.time) ++k;
    const auto &a = (*input.trajectory)[run.epoch[index(k)]], &b = (*input.trajectory)[run.epoch[index(k + 1)]];
    if (g.time < a.time || b.time < g.time) continue;
    const double f = (g.time - a.time).seconds() / (b.time - a.time).seconds();
    const double s = run.mileage[index(k)] + f * (run.mileage[index(k + 1)] - run.mileage[index(k)]);
    const bool advances = out.s.empty() || (reversed ? s < out.s.back() : s > out.s.back());
    if (!advances) continue;
    out.s.push_back(s);
    out.value.push_back(t.gauge_offset + g.reading + t.gauge_temperature_factor * g.temperature);
  }
  if (reversed) {
    std::reverse(out.s.begin(), out.s.end());
    std::reverse(out.value.begin(), out.value.end());
  }
  if (!out.s.empty()) out.value = median_filter(out.s, out.value, options.gauge_median);
  return out;
}

/// What the wheels trace within one chunk, in the chunk's local frame.
struct Traces {
  std::vector<double> s1, s2, s3, roll;
  std::vector<Vector3d> r1, r2, r3;
  std::vector<double> h1, h2, h3;
};

class Chunk {
 public:
  Chunk(const GeometryInput& input, const GeometryOptions& options, const geodesy::ProjectMap& projection,
        const RunMileage& run, const GaugeLine& gauge, std::size_t first, std::size_t last)
      : options_(options), map_((*input.trajectory)[run.epoch[(first + last) / 2]].position, projection) {
    trace(input, run, gauge, first, last);
  }

  void fill(RailGrid& grid, std::size_t a, std::size_t b) const {
    const std::span<const double> at(grid.mileage.data() + a, b - a);
    const double h = options_.fit_half_width, gap = options_.max_gap, window = options_.average_window;
    const auto f1 = fit_moving(t_.s1, t_.r1, at, h, gap), f2 = fit_moving(t_.s2, t_.r2, at, h, gap);
    const auto f3 = fit_moving(t_.s3, t_.r3, at, h, gap);
    const auto h1 = moving_average(t_.s1, t_.h1, at, window, gap), h2 = moving_average(t_.s2, t_.h2, at, window, gap);
    const auto h3 = moving_average(t_.s3, t_.h3, at, window, gap);
    const auto roll = moving_average(t_.s3, t_.roll, at, window, gap);
    RailLine& reference = grid.reference_is_left ? grid.left : grid.right;
    RailLine& other = grid.reference_is_left ? grid.right : grid.left;
    const auto mean = [](double x, double y) { return std::isnan(x) ? y : (std::isnan(y) ? x : 0.5 * (x + y)); };
    for (std::size_t k = 0; k < at.size(); ++k) {
      const std::size_t i = a + k;
      const Vector3d r = f1[k].r.binaryExpr(f2[k].r, mean);
      put(reference, i, r, mean(h1[k], h2[k]), 0.5 * std::hypot(f1[k].sigma, f2[k].sigma));
      put(other, i, f3[k].r, h3[k], f3[k].sigma);
      grid.cross_level[i] = roll[k];
      grid.map_scale[i] = map_.scale();
      if (std::isnan(f3[k].r.x()) || std::isnan(r.x()))
        grid.flags[i] |= no_trajectory;
      else if (f3[k].half_width > h)
        grid.flags[i] |= few_samples;
    }
  }

 private:
  void put(RailLine& rail, std::size_t i, const Vector3d& ned, double height, double sigma) const {
    rail.ecef[i] = r0_ + C_en_ * ned;
    rail.map[i] = map_.forward(ned).head<2>();
    rail.height[i] = height;
    rail.fit_sigma[i] = static_cast<float>(sigma);
  }

  void trace(const GeometryInput& input, const RunMileage& run, const GaugeLine& gauge, std::size_t first,
             std::size_t last) {
    const Trolley& t = input.trolley;
    const geodesy::Geodetic origin = map_.frame().origin();
    r0_ = geodesy::wgs84.to_ecef(origin).r;
    C_en_ = geodesy::rotation_en(origin.latitude, origin.longitude);
    const Matrix3d C_bv = geodesy::to_matrix(t.mounting).transpose();
    const double side = t.reference_side(), to_head = 0.5 * (options_.rail_distance - options_.nominal_gauge);
    const double outward = options_.rail_point == RailPoint::head_centre ? to_head : 0.0;
    const std::span<const double> s(run.mileage.data() + first, last - first);
    const auto g = interpolated(gauge.s, gauge.value, s, options_.max_gap);
    for (std::size_t k = 0; k < s.size(); ++k) {
      const auto& p = (*input.trajectory)[run.epoch[first + k]];
      const Matrix3d C = map_.frame().rotation_from(p.position) * p.q_nb.toRotationMatrix() * C_bv;
      const Vector3d r = map_.frame().to_ned(p.position);
      const double y3 = t.reference_y - side * (std::isfinite(g[k]) ? g[k] : options_.nominal_gauge);
      const auto point = [&](double x, double y) -> Vector3d { return r + C * Vector3d(x, y, t.contact_z); };
      const auto height = [&](double x, double y) { return map_.forward(point(x, y)).z(); };
      const double y1 = t.reference_y + side * outward, head1 = t.reference_y + side * to_head;
      t_.s1.push_back(s[k] + run.direction * (t.front_x - t.other_x));
      t_.s2.push_back(s[k] + run.direction * (t.rear_x - t.other_x));
      t_.s3.push_back(s[k]);
      t_.r1.push_back(point(t.front_x, y1));
      t_.r2.push_back(point(t.rear_x, y1));
      t_.r3.push_back(point(t.other_x, y3 - side * outward));
      t_.h1.push_back(height(t.front_x, head1));
      t_.h2.push_back(height(t.rear_x, head1));
      t_.h3.push_back(height(t.other_x, y3 - side * to_head));
      const Matrix3d C_nv = p.q_nb.toRotationMatrix() * C_bv;
      t_.roll.push_back(run.direction * options_.rail_distance * std::sin(std::atan2(C_nv(2, 1), C_nv(2, 2))));
    }
  }

  const GeometryOptions& options_;
  LocalMap map_;
  Vector3d r0_;
  Matrix3d C_en_;
  Traces t_;
};

RailGrid empty_grid(const GeometryOptions& options, const RunMileage& run) {
  RailGrid grid;
  const double first = std::ceil(run.mileage.front() / options.step - 1e-9);
  const double last = std::floor(run.mileage.back() / options.step + 1e-9);
  for (double k = first; k <= last; k += 1.0) grid.mileage.push_back(k * options.step);
  const std::size_t n = grid.mileage.size();
  for (RailLine* rail : {&grid.left, &grid.right}) {
    rail->ecef.assign(n, Vector3d::Constant(nan));
    rail->map.assign(n, Eigen::Vector2d::Constant(nan));
    rail->height.assign(n, nan);
    rail->fit_sigma.assign(n, std::numeric_limits<float>::quiet_NaN());
  }
  for (auto* v : {&grid.cross_level, &grid.sensed_gauge, &grid.map_scale}) v->assign(n, nan);
  grid.epoch.assign(n, 0);
  grid.time.assign(n, Time{});
  grid.flags.assign(n, 0);
  return grid;
}

void stamp(const geodesy::Trajectory& trajectory, const RunMileage& run, RailGrid& grid) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < grid.mileage.size(); ++i) {
    while (k + 2 < run.mileage.size() && run.mileage[k + 1] <= grid.mileage[i]) ++k;
    const double f = std::clamp((grid.mileage[i] - run.mileage[k]) / (run.mileage[k + 1] - run.mileage[k]), 0.0, 1.0);
    const Time a = trajectory[run.epoch[k]].time, b = trajectory[run.epoch[k + 1]].time;
    grid.time[i] = a + Duration{std::llround(f * static_cast<double>((b - a).ns))};
    grid.epoch[i] = run.epoch[f < 0.5 ? k : k + 1];
  }
  for (const auto& [from, to] : run.repeated) {
    for (std::size_t i = 0; i < grid.mileage.size(); ++i) {
      if (grid.mileage[i] >= from && grid.mileage[i] <= to) grid.flags[i] |= repeated;
    }
  }
}

}  // namespace

RailGrid place_rails(const GeometryInput& input, const GeometryOptions& options, const geodesy::ProjectMap& projection,
                     const RunMileage& run, Progress& progress) {
  RailGrid grid = empty_grid(options, run);
  grid.reference_is_left = input.trolley.reference_side() * run.direction < 0.0;
  stamp(*input.trajectory, run, grid);
  const GaugeLine gauge = gauge_by_mileage(input, options, run);
  grid.sensed_gauge = moving_average(gauge.s, gauge.value, grid.mileage, options.average_window, options.max_gap);
  const std::size_t n = grid.mileage.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isnan(grid.sensed_gauge[i])) grid.flags[i] |= no_gauge;
  }
  const double margin = input.trolley.wheelbase() + 2.0 * options.fit_half_width + options.max_gap;
  const auto per_chunk = std::max<std::size_t>(8, static_cast<std::size_t>(300.0 / options.step));
  for (std::size_t a = 0; a < n && !progress.cancelled(); a += per_chunk) {
    const std::size_t b = std::min(n, a + per_chunk);
    const auto lower = std::lower_bound(run.mileage.begin(), run.mileage.end(), grid.mileage[a] - margin);
    const auto upper = std::upper_bound(lower, run.mileage.end(), grid.mileage[b - 1] + margin);
    if (upper - lower < 2) {
      for (std::size_t i = a; i < b; ++i) grid.flags[i] |= no_trajectory;
      continue;
    }
    Chunk(input, options, projection, run, gauge, static_cast<std::size_t>(lower - run.mileage.begin()),
          static_cast<std::size_t>(upper - run.mileage.begin()))
        .fill(grid, a, b);
    progress.report("rails", double(b) / double(n));
  }
  return grid;
}

}  // namespace versine::track
