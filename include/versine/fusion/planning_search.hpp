// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/fusion/planning_chain.hpp"

/// The questions of a buyer, asked the other way round. "Sigma" is the largest lateral or vertical standard deviation
/// anywhere along an interval.
namespace versine::fusion {

/// By which accuracy a plan is judged: an interval by itself (Jiang section 5; what the first interval of a survey
/// gives), or the middle of a chained run (what a longer survey gives).
enum class PlanBasis { interval, chain };

[[nodiscard]] double worst_sigma(const PlanCase& plan, PlanBasis basis);

/// Largest landmark spacing (m, to 0.1 m) that keeps `required`; none when even 1 m does not. At most 5 km.
[[nodiscard]] std::optional<double> largest_spacing(PlanCase plan, double required, PlanBasis basis);

/// Largest gyro random walk (rad/sqrt(s)) at the case's bias, and largest bias (rad/s) at its random walk.
[[nodiscard]] std::optional<double> largest_random_walk(PlanCase plan, double required, PlanBasis basis);
[[nodiscard]] std::optional<double> largest_bias(PlanCase plan, double required, PlanBasis basis);

/// How each known grade does.
struct GradeVerdict {
  std::string name;
  double sigma = 0.0;             ///< m
  std::optional<double> spacing;  ///< m, the largest it allows
};
[[nodiscard]] std::vector<GradeVerdict> judge_grades(const PlanCase& plan, double required, PlanBasis basis);

/// Jiang's figure 6: sigma at mid-interval over two error sizes.
struct SigmaMap {
  std::vector<double> x, y;   ///< SI
  std::vector<double> sigma;  ///< m, row by row: sigma[iy * x.size() + ix]
};
/// Over equivalent gyro bias (x, rad/s) and random walk (y, rad/sqrt(s)). In the lateral map the heading error follows
/// from the bias, as gyrocompassing leaves it.
[[nodiscard]] SigmaMap lateral_map(const PlanCase& plan, double largest_bias, double largest_walk, int points = 61);
[[nodiscard]] SigmaMap vertical_map(const PlanCase& plan, double largest_bias, double largest_walk, int points = 61);
/// Over odometer scale error (x) and its random walk (y, 1/sqrt(s)).
[[nodiscard]] SigmaMap longitudinal_map(const PlanCase& plan, double largest_scale, double largest_walk,
                                        int points = 61);

}  // namespace versine::fusion
