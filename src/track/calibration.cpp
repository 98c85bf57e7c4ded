// SPDX-License-Identifier: Apache-2.0
#include "versine/track/calibration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/design/alignment.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/track/mileage.hpp"
#include "versine/track/resampling.hpp"
#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

/// Azimuth of the trolley's path of travel around each kept epoch, over about `base` metres, along its x axis, true
/// north; the body's own point half-way turns with the path, so the chord's azimuth is that of the tangent.
std::vector<double> path_azimuth(const geodesy::Trajectory& trajectory, const RunMileage& run,
                                 const Eigen::Vector3d& lever, double base) {
  const std::size_t n = run.epoch.size();
  std::vector<double> out(n, nan);
  std::size_t a = 0, b = 0;
  for (std::size_t i = 0; i < n; ++i) {
    while (run.mileage[a] < run.mileage[i] - 0.5 * base) ++a;
    while (b + 1 < n && run.mileage[b] < run.mileage[i] + 0.5 * base) ++b;
    const auto &p = trajectory[run.epoch[a]], &q = trajectory[run.epoch[b]];
    const Eigen::Vector3d d = geodesy::wgs84.ned_difference(p.position, q.position) + q.q_nb * lever - p.q_nb * lever;
    if (run.mileage[b] - run.mileage[a] > 0.8 * base) out[i] = std::atan2(run.direction * d.y(), run.direction * d.x());
  }
  return out;
}

/// The x axis follows the reference rail, which is the other one after turning round: where the cant changes, the two
/// rails' gradients differ by its rate. Brings the pitch to that of the track's axis.
void remove_ramps(AttitudeLine& line, const Trolley& trolley, const GeometryOptions& options) {
  const double rail = trolley.reference_side() * line.direction < 0.0 ? 1.0 : -1.0;  // left: rises with the cross level
  std::vector<double> level;
  for (const double roll : line.roll) level.push_back(line.direction * options.rail_distance * std::sin(roll));
  const double ahead = (trolley.front_x - trolley.other_x) * line.direction / line.step;
  const double behind = (trolley.rear_x - trolley.other_x) * line.direction / line.step;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double rate = line.direction *
                        (grid_value(level, double(i) + ahead) - grid_value(level, double(i) + behind)) /
                        trolley.wheelbase();
    line.pitch[i] -= line.direction * rail * 0.5 * rate;
  }
}

struct Mean {
  double value = 0.0, sigma = 0.0;
};

/// Mean, and its sigma from the scatter of the means of stretches.
Mean mean_of(const std::vector<double>& x, std::size_t per_stretch) {
  std::vector<double> means;
  double all = 0;
  for (std::size_t a = 0; a < x.size(); a += per_stretch) {
    double sum = 0;
    const std::size_t b = std::min(x.size(), a + per_stretch);
    for (std::size_t i = a; i < b; ++i) sum += x[i];
    all += sum;
    means.push_back(sum / double(b - a));
  }
  Mean m{all / double(x.size()), nan};
  double s = 0;
  for (const double v : means) s += (v - m.value) * (v - m.value);
  if (means.size() > 1) m.sigma = std::sqrt(s / double(means.size() - 1) / double(means.size()));
  return m;
}

}  // namespace

Expected<AttitudeLine> attitude_line(const GeometryInput& input, const GeometryOptions& options, Progress& progress) {
  const auto projection = map_of(input);
  if (!projection) return tl::unexpected(projection.error());
  auto run = synchronise_mileage(input, options, *projection, options.step / 20.0);
  if (!run) return tl::unexpected(run.error());
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(input.trolley.mounting).transpose();
  const Eigen::Vector3d lever = C_bv * Eigen::Vector3d(0.5 * (input.trolley.front_x + input.trolley.rear_x),
                                                       input.trolley.reference_y, input.trolley.contact_z);
  const auto azimuth = path_azimuth(*input.trajectory, *run, lever, 2.0);
  std::vector<double> roll, pitch, heading;
  double convergence = 0.0, convergence_at = nan, slope = 0.0;
  for (std::size_t i = 0; i < run->epoch.size(); ++i) {
    const auto& p = (*input.trajectory)[run->epoch[i]];
    const geodesy::Euler e = geodesy::to_euler(Eigen::Matrix3d(p.q_nb.toRotationMatrix() * C_bv));
    double nominal = azimuth[i];
    if (input.design != nullptr) {
      // PROJ's factors are slow and convergence is as good as linear over 200 m.
      if (!(std::abs(run->mileage[i] - convergence_at) < 200.0)) {
        convergence = projection->distortion(p.position).convergence;
        convergence_at = run->mileage[i];
        const auto& far = (*input.trajectory)[run->epoch[std::min(i + 1000, run->epoch.size() - 1)]];
        const double ahead = run->mileage[std::min(i + 1000, run->epoch.size() - 1)] - run->mileage[i];
        slope = ahead > 1.0 ? (projection->distortion(far.position).convergence - convergence) / ahead : 0.0;
      }
      nominal = input.design->at(run->mileage[i]).heading + convergence + slope * (run->mileage[i] - convergence_at) +
                (run->direction > 0.0 ? 0.0 : std::numbers::pi);
    }
    roll.push_back(e.roll);
    pitch.push_back(e.pitch);
    heading.push_back(geodesy::wrap_pi(e.yaw - nominal));
    if (i % 4096 == 0) progress.report("attitude", double(i) / double(run->epoch.size()));
  }
  AttitudeLine out;
  out.step = options.step;
  out.direction = run->direction;
  for (double k = std::ceil(run->mileage.front() / options.step); k * options.step <= run->mileage.back(); k += 1.0) {
    out.mileage.push_back(k * options.step);
  }
  out.roll = moving_average(run->mileage, roll, out.mileage, options.step, options.max_gap);
  out.pitch = moving_average(run->mileage, pitch, out.mileage, options.step, options.max_gap);
  out.heading_error = moving_average(run->mileage, heading, out.mileage, options.step, options.max_gap);
  remove_ramps(out, input.trolley, options);
  return out;
}

Expected<MountingCalibration> calibrate_mounting(const std::vector<AttitudeLine>& passes, const geodesy::Euler& present,
                                                 double settle) {
  struct Cell {
    double roll[2] = {0, 0}, pitch[2] = {0, 0};
    int n[2] = {0, 0};
  };
  std::map<long long, Cell> cells;
  std::vector<double> heading;
  bool seen[2] = {false, false};
  double step = 0.25;
  for (const AttitudeLine& p : passes) {
    const int k = p.direction > 0.0 ? 0 : 1;
    seen[k] = true;
    step = p.step;
    for (std::size_t i = 0; i < p.mileage.size(); ++i) {
      if (!std::isfinite(p.roll[i]) || !std::isfinite(p.pitch[i])) continue;
      Cell& c = cells[std::llround(p.mileage[i] / p.step)];
      c.roll[k] += p.roll[i];
      c.pitch[k] += p.pitch[i];
      ++c.n[k];
      if (std::isfinite(p.heading_error[i])) heading.push_back(p.heading_error[i]);
    }
  }
  std::vector<double> roll, pitch;
  for (const auto& [key, c] : cells) {
    if (c.n[0] == 0 || c.n[1] == 0) continue;
    roll.push_back(0.5 * (c.roll[0] / c.n[0] + c.roll[1] / c.n[1]));
    pitch.push_back(0.5 * (c.pitch[0] / c.n[0] + c.pitch[1] / c.n[1]));
  }
  if (!seen[0] || !seen[1] || roll.empty()) {
    return fail({.field = "passes",
                 .found = seen[0] && seen[1] ? "no mileage that was passed in both orientations"
                                             : "passes in one orientation of the trolley only",
                 .expected = "the same stretch passed with the trolley both ways round",
                 .advice = "turn the trolley round (180 degrees) and pass the same stretch again; both passes need the "
                           "same design or marks for their mileage"});
  }
  const auto per = std::max<std::size_t>(1, static_cast<std::size_t>(settle / step));
  const Mean r = mean_of(roll, per), p = mean_of(pitch, per), h = mean_of(heading, per);
  MountingCalibration out;
  out.correction = {r.value, p.value, h.value};
  out.sigma = {r.sigma, p.sigma, h.sigma};
  // Computed attitude = true attitude times the error's rotation: the new C_vb is that rotation before the old one.
  out.mounting = geodesy::to_euler(Eigen::Matrix3d(geodesy::to_matrix(out.correction) * geodesy::to_matrix(present)));
  out.points = roll.size();
  out.length = double(roll.size()) * step;
  return out;
}

}  // namespace versine::track
