// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "studies.hpp"
#include "tunnel.hpp"
#include "versine/core/units.hpp"

namespace versine::study {

using namespace units;

int tunnel(std::uint64_t seed, double radius, double cant, double spacing, double mounting, double roughness) {
  simulation::Scenario s = tunnel_line(radius, cant, spacing);
  s.track.spectrum_factor = roughness;  // of the German low-disturbance spectrum
  const auto solved = solve(s, seed, mounting);
  if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
  fmt::print("\nR = {:.0f} m, cant {:.0f} mm, landmark every {:.0f} m, mounting off by {:.2f} mrad, seed {}\n\n",
             radius, cant / mm, spacing, mounting * 1e3, seed);
  fmt::print(
      "| method | part | lateral | vertical | longitudinal, mm | inside 1.96 sigma, % |\n|---|---|---|---|---|---|\n");
  judge(solved->reckoned.solution.smoothed, solved->recording, s).print("gyro/odometer/landmark");
  judge(solved->aided.solution.smoothed, solved->recording, s).print("aided INS");
  const auto d = difference(solved->reckoned.solution.smoothed, solved->aided.solution.smoothed);
  fmt::print("\ndifference of the methods, RMS: lateral {:.2f}, vertical {:.2f}, longitudinal {:.2f} mm\n", d[0] / mm,
             d[1] / mm, d[2] / mm);
  fmt::print("model error predicted, worst stretch: {:.2f} mm; rejected landmarks: {}\n",
             largest_model_error(solved->reckoned) / mm, solved->reckoned.solution.record.rejections.size());
  for (const auto& w : solved->reckoned.solution.record.warnings) fmt::print("warning: {}\n", w);
  for (const auto& v : solved->reckoned.observability.verdict) fmt::print("verdict: {}\n", v);
  return 0;
}

/// The tunnel with landmarks of 0.02 mm, quiet gyros and a smooth track, so that what is left is the reduced model's:
/// gyro bias, scale factor and misalignment, level, heading and mounting through curve and cant.
int validity(double mounting, int seeds) {
  fmt::print(
      "\n| R, m | cant, mm | landmark every, m | lateral | vertical, mm | to aided INS, lateral | vertical, mm | "
      "predicted, worst stretch, mm | warns |\n|---|---|---|---|---|---|---|---|---|\n");
  const std::pair<double, double> lines[] = {{std::numeric_limits<double>::infinity(), 0.0},
                                             {3000.0, 60.0},
                                             {800.0, 100.0},
                                             {400.0, 150.0},
                                             {250.0, 150.0},
                                             {150.0, 150.0}};
  for (const auto& [radius, cant] : lines) {
    for (const double spacing : {60.0, 120.0, 240.0}) {
      simulation::Scenario s = tunnel_line(radius, cant * mm, spacing);
      s.track.spectrum_factor = 1e-6;
      s.equipment.imu->errors.gyro.random_walk *= 0.02;
      s.equipment.total_station->sigma_position = 0.02 * mm;
      s.equipment.odometers[0].scale_walk = 0.0;
      s.equipment.odometers[0].quantum = 0.0;
      Eigen::Array2d squares = Eigen::Array2d::Zero(), apart = Eigen::Array2d::Zero();
      double predicted = 0.0;
      bool warns = false;
      for (int seed = 1; seed <= seeds; ++seed) {
        const auto solved = solve(s, std::uint64_t(seed), mounting);
        if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
        const TunnelErrors e = judge(solved->reckoned.solution.smoothed, solved->recording, s);
        Squares worst = e.straight;
        if (e.curve.count > 0.0) {
          worst = e.curve;
          worst.sum += e.ramp.sum;
          worst.count += e.ramp.count;
        }
        squares += worst.rms().head<2>().square() / seeds;
        apart +=
            difference(solved->reckoned.solution.smoothed, solved->aided.solution.smoothed).head<2>().square() / seeds;
        predicted = std::max(predicted, largest_model_error(solved->reckoned));
        for (const auto& w : solved->reckoned.solution.record.warnings) {
          warns = warns || w.find("reduced model") != std::string::npos;
        }
      }
      fmt::print("| {} | {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
                 std::isfinite(radius) ? fmt::format("{:.0f}", radius) : "straight", cant, spacing,
                 std::sqrt(squares[0]) / mm, std::sqrt(squares[1]) / mm, std::sqrt(apart[0]) / mm,
                 std::sqrt(apart[1]) / mm, predicted / mm, warns ? "yes" : "no");
    }
  }
  return 0;
}

}  // namespace versine::study
